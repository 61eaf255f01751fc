// A colour or spectrum: its expression, a swatch to choose by, names the program knows, and a plot.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import type { Member } from "../model/classes.ts";
import type { ColorValue, Data } from "../model/protocol.ts";
import { knownNames } from "../model/state.ts";
import { texts } from "../texts/texts.ts";
import { Dragging, setMember } from "./edit.ts";
import { Entry } from "./entry.tsx";
import type { FieldProps } from "./field_props.ts";
import { SpectrumPlot } from "./spectrum.tsx";

const t = texts.panel.color;

export function colorOf(value: Data | undefined): ColorValue | null {
  return typeof value === "object" && value !== null && "color" in value ? value.color : null;
}

/** Linear sRGB as a colour of the page; what is brighter than the screen is scaled down to it. */
export function swatch([r, g, b]: readonly number[]): string {
  const most = Math.max(1, r ?? 0, g ?? 0, b ?? 0);
  const encode = (v = 0): number => {
    const c = Math.max(0, v / most);
    return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  };
  return `#${[r, g, b].map((v) => encode(v).toString(16).padStart(2, "0")).join("")}`;
}

/** What may be meant, by what the colour is read as. */
function suggestions(meaning: string | undefined): string[] {
  const names = knownNames.value;
  if (meaning === "index") return [...names.metals.map((m) => `metal("${m}")`), ...names.glasses.map((g) => `glass("${g}")`), "1.5", "complex(0.2, 3)"];
  if (meaning === "radiance") return [...names.illuminants.map((i) => `illuminant("${i}")`), "blackbody(2856 K)", "1", "rgb(1, 1, 1)"];
  if (meaning === "number") return [];
  return ["0.5", "rgb(0.5, 0.5, 0.5)", 'srgb("#808080")', ...names.illuminants.map((i) => `illuminant("${i}")`)];
}

export function ColorField(props: FieldProps): JSX.Element {
  return <ColorEntry {...props} color={colorOf(props.state.value)} />;
}

interface ColorEntryProps {
  id: string;
  component: { id: number };
  member: Member;
  state: { text: string };
  color: ColorValue | null;
}

export function ColorEntry({ id, component, member, state, color }: ColorEntryProps): JSX.Element {
  const plot = useSignal(false);
  const known = suggestions(member.meaning);
  return (
    <div class="color">
      {color && <Swatch component={component.id} member={member} color={color} />}
      <Entry id={id} text={state.text} label={member.name} list={known.length ? `${id}-known` : undefined}
        commit={(text) => setMember(component.id, member.name, text)} />
      {known.length > 0 && (
        <datalist id={`${id}-known`}>
          {known.map((k) => (
            <option key={k} value={k} />
          ))}
        </datalist>
      )}
      {color?.wavelengths && color.values && (
        <>
          <button type="button" class="button square" aria-expanded={plot.value} aria-label={t.plot} title={t.plot} onClick={() => (plot.value = !plot.value)}>
            <SpectrumPlot small wavelengths={color.wavelengths} values={color.values} />
          </button>
          {plot.value && <SpectrumPlot wavelengths={color.wavelengths} values={color.values} />}
        </>
      )}
    </div>
  );
}

function Swatch({ component, member, color }: { component: number; member: Member; color: ColorValue }): JSX.Element {
  const hex = swatch(color.srgb);
  const drag = { current: null as Dragging | null };
  return (
    <input
      type="color"
      class="swatch"
      value={hex}
      title={t.swatch}
      aria-label={`${member.name}: ${t.swatch}`}
      disabled={member.meaning === "index"}
      onInput={(e) => {
        drag.current ??= new Dragging(component, member.name);
        drag.current.set(`srgb("${e.currentTarget.value}")`);
      }}
    />
  );
}
