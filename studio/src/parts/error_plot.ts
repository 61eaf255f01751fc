// Relative errors over seconds, both by their logarithms.
import UPlot from "uplot";
import { brief } from "../model/numbers.ts";

export function errorPlot(parent: HTMLElement, dark: boolean, height: number, lines: UPlot.Series[], data: UPlot.AlignedData): UPlot {
  const grid = { stroke: dark ? "#ffffff14" : "#00000014", width: 1 };
  const axis = { stroke: dark ? "#aab4be" : "#4d5863", grid, ticks: grid, font: "11px system-ui" };
  return new UPlot(
    {
      width: Math.max(200, parent.clientWidth),
      height,
      legend: { show: false },
      cursor: { y: false },
      scales: { x: { time: false, distr: 3, log: 10 }, y: { distr: 3, log: 10 } },
      axes: [
        { ...axis, size: 28, values: (_u, v) => v.map((x) => (x === null ? "" : `${brief(x, 2)} s`)) },
        { ...axis, size: 52, values: (_u, v) => v.map((y) => (y === null ? "" : `${brief(y, 2)} %`)) },
      ],
      series: [{}, ...lines],
    },
    data,
    parent,
  );
}
