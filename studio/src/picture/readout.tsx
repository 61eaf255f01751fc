// The numbers of the pixel at the cursor: at once those of the picture on the page, then those that the program answers.
import { computed } from "@preact/signals";
import type { JSX } from "preact";
import { brief, percent } from "../model/numbers.ts";
import { viewing } from "../model/state.ts";
import { texts } from "../texts/texts.ts";
import { isBand } from "./bands.ts";
import { luminance } from "./film.ts";
import { cursor, probe } from "./probe.ts";
import { zoom } from "./state.ts";
import { pixelsVersion, relit, samplesShown, shownFilm, size } from "./store.ts";

const here = computed(() => {
  void pixelsVersion.value;
  const pixel = cursor.value;
  const film = shownFilm.value;
  if (!pixel || !film) return null;
  const x = Math.floor((pixel.x / size.value.width) * film.width);
  const y = Math.floor((pixel.y / size.value.height) * film.height);
  return { ...pixel, rgb: film.rgb(x, y) };
});

const number = (v: number | string): string => (typeof v === "number" && Number.isFinite(v) ? brief(v, 4) : String(v));

export function PixelNumbers(): JSX.Element {
  const now = here.value;
  const weighed = relit.value !== null;
  const known = probe.value && now && probe.value.x === now.x && probe.value.y === now.y ? probe.value : null;
  return (
    <div class="pixel-numbers" id="picture-numbers" aria-live="off">
      {now ? (
        <dl>
          <Item label={texts.picture.pixel} value={`${now.x}, ${now.y}`} width={9} />
          <Item label="RGB" value={(weighed ? now.rgb : (known?.rgb ?? now.rgb)).map(number).join("  ")} width={22} />
          {!weighed && <Item label="XYZ" value={known ? known.xyz.map(number).join("  ") : "…"} width={22} />}
          <Item label="Y" value={number(known && !weighed ? known.xyz[1] : luminance(now.rgb))} width={7} />
          {!viewing.value && <Item label={texts.picture.samples} value={brief(known?.samples ?? samplesShown.value)} width={6} />}
          {!viewing.value && <Item label={texts.picture.error} value={known?.error != null ? percent(known.error) : "–"} width={7} />}
          {Object.entries(known?.layers ?? {}).filter(([name]) => !isBand(name)).map(([name, v]) => (
            <Item key={name} label={name} value={(Array.isArray(v) ? v : [v]).map(number).join("  ")} width={6} />
          ))}
        </dl>
      ) : (
        <span class="dim">{size.value.width ? texts.picture.size(size.value.width, size.value.height, samplesShown.value, percent(zoom.value)) : ""}</span>
      )}
    </div>
  );
}

function Item({ label, value, width }: { label: string; value: string; width: number }): JSX.Element {
  return (
    <div>
      <dt>{label}</dt>
      <dd style={{ minWidth: `${width}ch` }}>{value}</dd>
    </div>
  );
}
