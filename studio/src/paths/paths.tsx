// The path debugger: what light took which way to a pixel.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { brief, percent } from "../model/numbers.ts";
import { Refused } from "../model/protocol.ts";
import { progress, tab } from "../model/state.ts";
import { demand } from "../model/studio.ts";
import { Button } from "../parts/parts.tsx";
import { mode, pathPixel } from "../picture/state.ts";
import { texts } from "../texts/texts.ts";
import { HeldLight } from "./held_light.tsx";
import type { Replay, ReplayedPath, Vertex } from "./model.ts";
import { pathColors, type Chosen } from "./space.ts";
import { SpaceView } from "./space_view.tsx";

const t = texts.paths;

interface Firefly {
  x: number;
  y: number;
  sample: number;
  luminance: number;
  ratio: number | null;
}

const replay = signal<Replay | null>(null);
const loading = signal(false);
const problem = signal("");
const chosen = signal<Chosen | null>(null);
const fireflies = signal<{ samples: Firefly[]; kept: boolean; refused: string | null } | null>(null);

async function load(x: number, y: number, sample?: number): Promise<void> {
  loading.value = true;
  problem.value = "";
  chosen.value = null;
  try {
    const said = await demand<{ replay: Replay }>("replay", { x, y, paths: 8, ...(sample === undefined ? {} : { sample }) });
    replay.value = said.replay;
    if (said.replay.paths.length) chosen.value = { path: 0, vertex: 0 };
  } catch (error) {
    replay.value = null;
    problem.value = error instanceof Refused ? error.message : texts.notices.offline;
  } finally {
    loading.value = false;
  }
}

async function findFireflies(): Promise<void> {
  try {
    const said = await demand<{ samples: Firefly[]; kept?: boolean; refused?: string | null }>("fireflies", { count: 20 });
    fireflies.value = { samples: said.samples, kept: said.kept !== false, refused: said.refused ?? null };
  } catch (error) {
    problem.value = error instanceof Refused ? error.message : texts.notices.offline;
  }
}

export function Paths(): JSX.Element {
  const pixel = pathPixel.value;
  useEffect(() => {
    const now = replay.value;
    if (pixel && (!now || now.pixel[0] !== pixel.x || now.pixel[1] !== pixel.y)) void load(pixel.x, pixel.y);
  }, [pixel?.x, pixel?.y, progress.value?.generation]);
  const paths = replay.value?.paths ?? [];
  return (
    <div class="paths">
      <SpaceView paths={paths} chosen={chosen} />
      <div class="paths-side" tabIndex={0} role="region" aria-label={t.list}>
        <h2 class="small">{pixel ? t.of(pixel.x, pixel.y) : t.list}</h2>
        {!pixel && <p class="dim">{t.choose}</p>}
        <Button label={t.goChoose} onClick={() => ((mode.value = "paths"), (tab.value = "picture"))} />
        {loading.value && <p role="status" class="dim">{t.loading}</p>}
        {problem.value && <p class="wrong" role="alert">{problem.value}</p>}
        {pixel && !loading.value && !problem.value && paths.length === 0 && <p class="dim">{t.none}</p>}
        <ol class="plain path-list">
          {paths.map((path, i) => (
            <li key={i}>
              <PathView path={path} at={i} />
            </li>
          ))}
        </ol>
        <HeldLight />
        <h2 class="small">{t.fireflies}</h2>
        <Button label={t.findFireflies} onClick={() => void findFireflies()} />
        {fireflies.value && fireflies.value.samples.length === 0 && <p class="dim">{t.noFireflies}</p>}
        {fireflies.value?.refused && <p class="dim" role="status">{t.refused(fireflies.value.refused)}</p>}
        <ul class="plain">
          {fireflies.value?.samples.map((f) => (
            <li key={`${f.x}.${f.y}.${f.sample}`}>
              {fireflies.value?.refused ? (
                <span>{f.x}, {f.y} · Y {brief(f.luminance, 3)}{f.ratio !== null && ` · ${brief(f.ratio, 3)}×`}</span>
              ) : (
                <button type="button" class="link" onClick={() => ((pathPixel.value = { x: f.x, y: f.y }), void load(f.x, f.y, f.sample))}>
                  {f.x}, {f.y} · {t.sample(f.sample)} · Y {brief(f.luminance, 3)}
                  {f.ratio !== null && ` · ${brief(f.ratio, 3)}×`}
                </button>
              )}
            </li>
          ))}
        </ul>
      </div>
    </div>
  );
}

function PathView({ path, at }: { path: ReplayedPath; at: number }): JSX.Element {
  const open = chosen.value?.path === at;
  return (
    <>
      <button type="button" class={`path-head${open ? " open" : ""}`} aria-expanded={open} onClick={() => (chosen.value = open ? null : { path: at, vertex: 0 })}>
        <span class="dot" style={{ background: pathColors[at % pathColors.length] }} />
        <span>{t.sample(path.sample)}</span>
        <span class="spring" />
        <span>Y {path.luminance === null ? "–" : brief(path.luminance, 3)}</span>
        {path.share !== null && <span class="dim">{t.share(percent(path.share))}</span>}
      </button>
      {open && (
        <div class="path-body">
          <ol class="plain">
            {path.vertices.map((v, i) => (
              <li key={i}>
                <button type="button" class={`vertex${chosen.value?.vertex === i ? " chosen" : ""}`} onClick={() => (chosen.value = { path: at, vertex: i })}>
                  <b>{i}</b> {v.kind} {v.object}
                  <span class="dim"> {v.lobe}</span>
                </button>
                {chosen.value?.vertex === i && <VertexFacts vertex={v} />}
              </li>
            ))}
          </ol>
          <table class="contributions">
            <tbody>
              {path.contributions.map((c, i) => (
                <tr key={i}>
                  <td>{c.strategy}</td>
                  <td>{c.length}</td>
                  <td>w {c.weight === null ? "–" : brief(c.weight, 3)}</td>
                  <td>Y {c.luminance === null ? "–" : brief(c.luminance, 3)}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
    </>
  );
}

function VertexFacts({ vertex }: { vertex: Vertex }): JSX.Element {
  const list = (v: (number | null)[] | null): string => (v ?? []).map((n) => (n === null ? "–" : brief(n, 3))).join("  ");
  const lit = (v: (number | null)[]): boolean => v.some((n) => n !== null && n !== 0);
  const rows: [string, string][] = [
    ["position", list(vertex.position)],
    ["normal", list(vertex.normal)],
    ["pdf", vertex.density === null ? "–" : brief(vertex.density, 4)],
    ["throughput", list(vertex.throughput)],
    ...(lit(vertex.emitted) ? ([["emitted", list(vertex.emitted)]] as [string, string][]) : []),
    ...(lit(vertex.direct) ? ([["direct", list(vertex.direct)]] as [string, string][]) : []),
    ...(vertex.note ? ([["note", vertex.note]] as [string, string][]) : []),
  ];
  return (
    <dl class="vertex-facts">
      {rows.map(([name, value]) => (
        <div key={name}>
          <dt>{name}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
