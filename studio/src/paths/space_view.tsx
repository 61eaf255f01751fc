// The drawing in three dimensions on the page: it follows the scene, the paths that are shown, and what is selected.
import { useSignal, type Signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { progress } from "../model/state.ts";
import { demand } from "../model/studio.ts";
import { isDark } from "../model/theme.ts";
import { texts } from "../texts/texts.ts";
import type { ReplayedPath, Wireframe } from "./model.ts";
import { lobes, photons } from "./held_light.tsx";
import { GizmoBar, gizmoMode, heldNow, Placement, target } from "./placing.tsx";
import { Space, type Chosen } from "./space.ts";

const t = texts.paths;

export function SpaceView({ paths, chosen }: { paths: ReplayedPath[]; chosen: Signal<Chosen | null> }): JSX.Element {
  const box = useRef<HTMLDivElement>(null);
  const space = useSignal<Space | null>(null);
  const failed = useSignal("");
  const looked = useRef(false);
  const dragged = useSignal(0);
  const shown = useSignal(0);
  /** The component whose handles are shown. */
  const handled = useSignal<number | null>(null);
  useEffect(() => {
    let ended = false;
    const begin = async (): Promise<void> => {
      const three = await import("./three_parts.ts");
      if (ended || !box.current) return;
      try {
        const placement = new Placement();
        space.value = new Space(three, box.current, (what) => (chosen.value = what), (change, step) => {
          placement.take(change, step);
          if (step === "end") dragged.value += 1;
        });
      } catch {
        failed.value = t.noWebGl;
        return;
      }
    };
    void begin();
    return () => {
      ended = true;
      space.value?.dispose();
    };
  }, []);
  // Where the camera of the drawing is stays as it is when the scene changes.
  useEffect(() => {
    const now = space.value;
    if (!now || now.gizmo.dragging) return;
    const timer = setTimeout(() => {
      const show = (found: Wireframe): void => {
        now.show(found, isDark.value, !looked.current);
        shown.value += 1;
        looked.current ||= found.lines.length > 0;
      };
      demand<Wireframe>("wireframe", { most: 50000 }).then(show, () => show({ lines: [] }));
    }, looked.current ? 300 : 0);
    return () => clearTimeout(timer);
  }, [space.value, progress.value?.generation, isDark.value]);
  const held = target.value;
  useEffect(() => {
    const now = space.value;
    let current = true;
    if (now && !now.gizmo.dragging) {
      const id = held?.component.id ?? null;
      void heldNow().then((found) => {
        if (!current) return;
        now.gizmo.hold(found, gizmoMode.value);
        handled.value = found && id;
      });
    }
    return () => {
      current = false;
    };
  }, [space.value, held?.component.id, held?.state.text, held?.use?.id, gizmoMode.value, progress.value?.generation, dragged.value]);
  useEffect(() => space.value?.background(isDark.value ? "#14171a" : "#eef0f2"), [isDark.value, space.value]);
  useEffect(() => space.value?.drawPaths(paths, chosen.value), [paths, chosen.value, space.value]);
  useEffect(() => space.value?.drawLight(photons.value, lobes.value), [photons.value, lobes.value, space.value, shown.value]);
  return (
    <div class="space-pane">
      <GizmoBar />
      <div class="space" ref={box} role="img" aria-label={t.scene} aria-busy={shown.value === 0 && !failed.value} data-handles={handled.value ?? ""}>
        {failed.value && <p class="empty-note">{failed.value}</p>}
      </div>
    </div>
  );
}
