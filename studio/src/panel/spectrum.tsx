// A spectrum as a curve over wavelengths, above the colours that they have.
import type { JSX } from "preact";
import { brief } from "../model/numbers.ts";
import { texts } from "../texts/texts.ts";

interface Props {
  wavelengths: number[];
  values: number[];
  /** Standard errors of the values, for a band around the curve. */
  errors?: number[];
  small?: boolean;
}

export function SpectrumPlot({ wavelengths, values, errors, small }: Props): JSX.Element {
  const [width, height] = small ? [28, 14] : [260, 84];
  const low = wavelengths[0] ?? 360;
  const high = wavelengths[wavelengths.length - 1] ?? 830;
  const most = Math.max(1e-30, ...values.map((v, i) => v + (errors?.[i] ?? 0)));
  const point = (w: number, value: number): string => {
    const y = height - Math.max(0, value / most) * (height - 3);
    return `${(((w - low) / Math.max(1e-9, high - low)) * width).toFixed(1)},${y.toFixed(1)}`;
  };
  const points = wavelengths.map((w, i) => point(w, values[i] ?? 0));
  // Forth along the upper edge, and back along the lower one.
  const edge = (sign: number): string[] => wavelengths.map((w, i) => point(w, (values[i] ?? 0) + sign * (errors?.[i] ?? 0)));
  const label = texts.panel.color.plotSays(low, high, brief(most, 3));
  return (
    <svg class={`spectrum${small ? " small" : ""}`} viewBox={`0 0 ${width} ${height + (small ? 0 : 14)}`} role={small ? "presentation" : "img"} aria-label={small ? undefined : label}>
      {!small && (
        <>
          <defs>
            <linearGradient id="rainbow">
              {[[380, "#3b0a6b"], [440, "#2b3fe0"], [490, "#00b7d9"], [530, "#27c93f"], [580, "#f5e21b"], [620, "#f4761b"], [680, "#c8102e"], [740, "#5a0a12"]].map(
                ([w, c]) => (
                  <stop key={w} offset={`${(((w as number) - low) / (high - low)) * 100}%`} stop-color={c as string} />
                ),
              )}
            </linearGradient>
          </defs>
          <rect x="0" y={height} width={width} height="3" fill="url(#rainbow)" />
          <text x="0" y={height + 13}>{brief(low, 3)} nm</text>
          <text x={width} y={height + 13} text-anchor="end">{brief(high, 3)} nm</text>
          <text x="2" y="9">{brief(most, 3)}</text>
        </>
      )}
      {errors && <polygon class="spectrum-error" points={[...edge(1), ...edge(-1).reverse()].join(" ")} />}
      <polyline points={points.join(" ")} fill="none" stroke="currentColor" stroke-width="1.4" />
    </svg>
  );
}
