// Sliders and colours of the light groups that the render keeps as layers.
import type { JSX } from "preact";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { gainOf, groups, most, relight, relighting, resetGains, setGain } from "./lights.ts";
import * as store from "./store.ts";

const t = texts.lights;

export function LightGroups(): JSX.Element | null {
  if (!groups.value.length) return null;
  return (
    <details class="drop lights">
      <summary class="button" title={t.title} aria-label={t.title}>{t.button}{relighting.value ? " ●" : ""}</summary>
      <div class="drop-content" role="group" aria-label={t.title}>
        <label class="check">
          <input type="checkbox" checked={relighting.value}
            onChange={(e) => {
              if (e.currentTarget.checked) store.layer.value = "";
              relight(e.currentTarget.checked);
            }} />
          {t.active}
        </label>
        <p class="dim">{t.help}</p>
        {groups.value.slice(0, most).map((name) => <Group key={name} name={name} />)}
        {groups.value.length > most && <p class="dim">{t.tooMany(most)}</p>}
        {relighting.value && store.curve.value === "program" && <p class="dim">{t.toneMap}</p>}
        <div class="cluster"><Button label={t.reset} onClick={resetGains} /></div>
      </div>
    </details>
  );
}

function Group({ name }: { name: string }): JSX.Element {
  const { on, stops, color } = gainOf(name);
  const said = name === "rest" ? t.rest : name;
  const setStops = (e: JSX.TargetedEvent<HTMLInputElement>): void => {
    const value = Number(e.currentTarget.value);
    if (e.currentTarget.value !== "" && Number.isFinite(value)) setGain(name, { stops: Math.min(20, Math.max(-20, value)) });
  };
  return (
    <div class="light-group">
      <label class="check" title={said}>
        <input type="checkbox" aria-label={t.on(said)} checked={on} onChange={(e) => setGain(name, { on: e.currentTarget.checked })} />
        <span>{said}</span>
      </label>
      <input type="color" aria-label={t.color(said)} title={t.color(said)} value={color} onInput={(e) => setGain(name, { color: e.currentTarget.value })} />
      <input type="range" aria-label={t.stops(said)} title={t.stops(said)} min={-6} max={6} step={0.05} value={stops} onInput={setStops} />
      <input type="number" class="narrow" aria-label={t.stopsNumber(said)} min={-20} max={20} step={0.25} value={Number(stops.toFixed(2))} onInput={setStops} />
    </div>
  );
}
