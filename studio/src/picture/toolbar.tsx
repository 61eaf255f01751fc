// The row of tools above the picture.
import type { JSX } from "preact";
import { document_, progress, readOnly, tab, viewing } from "../model/state.ts";
import { pictureLayer, watch } from "../model/studio.ts";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { frameSelected } from "./camera.ts";
import { badMarks } from "./bad.ts";
import { automaticStops } from "./film.ts";
import { LightGroups } from "./light_groups.tsx";
import { HistogramView } from "./histogram.tsx";
import { command, crop, mode, movesCamera, pathPixel, setCrop, type Mode } from "./state.ts";
import { watchedPicture } from "./probe.ts";
import { savePicture } from "./save.tsx";
import * as store from "./store.ts";
import { learn, unknownTools } from "./tools.ts";
import { ViewedPictures } from "./viewed.tsx";
import { Views } from "./views.tsx";
import { PixelSpectrum } from "./pixel_spectrum.tsx";
import { WaveformView } from "./waveform.tsx";

const t = texts.picture;

function setCurve(curve: store.Curve): void {
  store.curve.value = curve;
  follow();
}

/** Asks for the pixels that what is chosen needs. */
function follow(): void {
  if (store.curve.value === "program" && watchedPicture.value === null && !store.falseColor.value && store.compare.value === "none" && !store.layer.value) {
    watch({ what: "toned" });
  } else if (watchedPicture.value !== null) watch({ what: "linear", layer: pictureLayer(watchedPicture.value) });
  else watch(store.layer.value ? { what: "linear", layer: store.layer.value } : { what: "linear" });
}

export function PictureToolbar(): JSX.Element {
  const all: { name: Mode; label: string; icon: "search" | "crop" | "orbit" | "fly" | "SceneObject" | "link" }[] = [
    { name: "look", label: t.modes.look, icon: "search" },
    { name: "pick", label: t.modes.pick, icon: "SceneObject" },
    { name: "orbit", label: t.modes.orbit, icon: "orbit" },
    { name: "fly", label: t.modes.fly, icon: "fly" },
    { name: "crop", label: t.modes.crop, icon: "crop" },
    { name: "paths", label: t.modes.paths, icon: "link" },
  ];
  const modes = viewing.value ? [] : all;
  return (
    <div class="toolbar picture-bar" role="toolbar" aria-label={t.toolbar}>
      <div class="cluster" role="group" aria-label={t.mouse}>
        {modes.map((m) => (
          <Button key={m.name} icon={m.icon} label={m.label} short={unknownTools.value.has(m.name) ? t.modeNames[m.name] : undefined}
            pressed={mode.value === m.name} disabled={movesCamera(m.name) && readOnly.value} onClick={() => ((mode.value = m.name), learn([m.name]))} />
        ))}
        {modes.some((m) => unknownTools.value.has(m.name)) && <Button icon="close" label={t.hideNames} onClick={() => learn(modes.map((m) => m.name))} />}
        {crop.value && <Button label={t.wholePicture} onClick={() => void setCrop(null)} />}
        {movesCamera(mode.value) && <Button icon="target" label={t.frame} onClick={frameSelected} />}
      </div>
      <div class="cluster" role="group" aria-label={t.zoom}>
        <Button icon="fit" label={t.fit} keys="F" onClick={() => command("fit")} />
        <Button label="1:1" hint={`${t.one} (1)`} onClick={() => command("one")} />
      </div>
      <Exposure />
      <select aria-label={t.curve} title={t.curve} value={store.curve.value} onChange={(e) => setCurve(e.currentTarget.value as store.Curve)}>
        {(["program", "filmic", "linear", "reinhard"] as const).map((c) => (
            <option key={c} value={c}>
              {t.curves[c]}
            </option>
          ))}
      </select>
      <Layers />
      <LightGroups />
      <div class="cluster end">
        {viewing.value ? <ViewedPictures /> : <Views />}
        <details class="drop">
          <summary class="button" title={t.more}>{t.more}</summary>
          <More />
        </details>
      </div>
    </div>
  );
}

function Exposure(): JSX.Element {
  const disabled = store.shownCurve.value === "program" && !store.falseColor.value && store.compare.value === "none";
  const change = (e: JSX.TargetedEvent<HTMLInputElement>): void => {
    store.expose(Number(e.currentTarget.value));
  };
  return (
    <div class="cluster exposure">
      <label class="inline" title={t.exposure}>
        <span>{t.exposure}</span>
        <input type="range" aria-label={t.exposure} min={-10} max={10} step={0.05} value={store.stops.value} disabled={disabled} onInput={change} />
      </label>
      <input type="number" class="narrow" aria-label={t.exposureStops} min={-30} max={30} step={0.25} disabled={disabled}
        value={Number(store.stops.value.toFixed(2))} onInput={change} />
      <Button label={t.automatic} disabled={disabled} onClick={() => store.shownFilm.value && store.expose(automaticStops(store.shownFilm.value))} />
    </div>
  );
}

function Layers(): JSX.Element | null {
  const layers = progress.value?.layers ?? [];
  if (!layers.length) return null;
  return (
      <select
        aria-label={t.layer}
        title={t.layer}
        value={store.layer.value}
        onChange={(e) => {
          store.layer.value = e.currentTarget.value;
          follow();
        }}
      >
        <option value="">{t.light}</option>
        {layers.map((l) => (
          <option key={l}>{l}</option>
        ))}
      </select>
  );
}

function More(): JSX.Element {
  const pinned = store.pinned.value;
  const range = store.falseRange.value;
  const setRange = (end: 0 | 1) => (e: JSX.TargetedEvent<HTMLInputElement>) => {
    const value = Number(e.currentTarget.value);
    store.falseRange.value = end === 0 ? [Math.min(value, range[1] - 0.5), range[1]] : [range[0], Math.max(value, range[0] + 0.5)];
  };
  return (
    <div class="drop-content">
      <HistogramView />
      <WaveformView />
      <PixelSpectrum />
      <label class="check">
        <input
          type="checkbox"
          checked={store.falseColor.value}
          onChange={(e) => {
            store.falseColor.value = e.currentTarget.checked;
            follow();
          }}
        />
        {t.falseColor}
      </label>
      {store.falseColor.value && (
        <div class="pair">
          {([0, 1] as const).map((end) => (
            <label key={end} class="inline">
              <span>2^</span>
              <input type="number" class="narrow" step={0.5} value={range[end]} aria-label={end ? t.falseHigh : t.falseLow} onInput={setRange(end)} />
            </label>
          ))}
          <span class="turbo" aria-hidden="true" />
        </div>
      )}
      <label class="check">
        <input type="checkbox" checked={store.markBad.value} onChange={(e) => (store.markBad.value = e.currentTarget.checked)} />
        {t.markBad(progress.value?.bad_samples ?? 0)}
      </label>
      {badMarks.value.length > 0 && (
        <ul class="plain scroll bad-list" aria-label={t.badList}>
          {badMarks.value.slice(0, 50).map((b) => (
            <li key={`${b.x}.${b.y}.${b.sample}`}>
              <button type="button" class="link" onClick={() => ((pathPixel.value = { x: b.x, y: b.y }), (tab.value = "paths"))}>{t.badAt(b.x, b.y, b.kind)}</button>
            </li>
          ))}
        </ul>
      )}
      <hr />
      <div class="cluster">
        <Button icon="pin" text label={pinned ? t.pinAgain : t.pin} disabled={!store.film.value}
          onClick={() => {
            store.pin(t.pinnedTitle(watchedPicture.value ?? document_.value?.title ?? "", store.samplesShown.value));
            follow();
          }} />
        {pinned && <Button label={t.unpin} onClick={() => (store.unpin(), follow())} />}
      </div>
      {pinned && (
        <>
          <p class="dim">{pinned.title}</p>
          <div class="cluster" role="group" aria-label={t.compare}>
            {(["none", "split", "flicker", "difference"] as const).map((c) => (
              <Button key={c} label={t.compares[c]} pressed={store.compare.value === c} onClick={() => ((store.compare.value = c), follow())} />
            ))}
          </div>
          {store.compare.value === "split" && (
            <label class="inline">
              <span>{t.splitAt}</span>
              <input type="range" min={0} max={1} step={0.01} value={store.split.value} onInput={(e) => (store.split.value = Number(e.currentTarget.value))} />
            </label>
          )}
        </>
      )}
      <hr />
      <div class="cluster">
        <Button icon="save" text label={t.save} disabled={!store.film.value || viewing.value} onClick={() => (savePicture.value = true)} />
      </div>
    </div>
  );
}
