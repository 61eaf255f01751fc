// The picture's place on the page: two canvases, one above the other, and the numbers of a pixel below.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { progress } from "../model/state.ts";
import { Awaited } from "../parts/working.tsx";
import { texts } from "../texts/texts.ts";
import { PictureCanvas } from "./canvas.ts";
import { PictureInput } from "./input.ts";
import { PixelNumbers } from "./readout.tsx";
import { mode, onCommand } from "./state.ts";
import * as store from "./store.ts";

export function Picture(): JSX.Element {
  const box = useRef<HTMLDivElement>(null);
  const below = useRef<HTMLCanvasElement>(null);
  const above = useRef<HTMLCanvasElement>(null);
  const input = useRef<PictureInput | null>(null);
  const canvas = useRef<PictureCanvas | null>(null);
  const failure = useSignal("");

  useEffect(() => {
    if (!below.current || !above.current || !box.current) return;
    let made: PictureCanvas;
    try {
      made = new PictureCanvas(below.current, above.current, box.current);
    } catch {
      failure.value = texts.picture.noWebGl;
      return;
    }
    canvas.current = made;
    input.current = new PictureInput(made);
    const end = onCommand((name) => made.zoomBy(name));
    return () => {
      end();
      made.dispose();
    };
  }, []);

  const there = store.shownFilm.value !== null || store.toned.value !== null;
  return (
    <div class={`picture mode-${mode.value}`}>
      <div class="canvases" ref={box}>
        <canvas ref={below} class={`picture-canvas${there ? "" : " blank"}`} />
        <canvas
          ref={above}
          class="picture-over"
          tabIndex={0}
          role="application"
          aria-label={texts.picture.canvas}
          aria-describedby="picture-numbers"
          onPointerDown={(e) => input.current?.down(e)}
          onPointerMove={(e) => input.current?.move(e)}
          onPointerUp={(e) => input.current?.up(e)}
          onPointerLeave={() => input.current?.leave()}
          onWheel={(e) => input.current?.wheel(e)}
          onDblClick={() => canvas.current?.zoomBy("fit")}
          onKeyDown={(e) => input.current?.key(e)}
          onKeyUp={() => input.current?.keyUp()}
          onContextMenu={(e) => e.preventDefault()}
        />
        {failure.value && <p class="empty-note">{failure.value}</p>}
        {!there && !failure.value && (
          <Awaited details>{progress.value?.state === "rendering" ? texts.working.firstPass : texts.picture.none}</Awaited>
        )}
      </div>
      <PixelNumbers />
    </div>
  );
}
