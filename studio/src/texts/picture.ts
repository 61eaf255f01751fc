// What the page says about pictures.
import { count } from "./count.ts";

export const picture = {
  canvas: "The picture. Arrow keys move from pixel to pixel, plus and minus zoom, F fits, E and Shift+E change the exposure.",
  none: "No picture yet.",
  noWebGl: "This browser cannot show the picture: it has no WebGL 2.",
  toolbar: "Picture",
  mouse: "What the mouse does",
  modes: { look: "Look", pick: "Select objects", orbit: "Move the camera", fly: "Fly: W A S D, Q E, drag to look about", crop: "Crop: render a part first", paths: "Paths of a pixel" },
  wholePicture: "Whole picture",
  frame: "Look at selected",
  zoom: "Zoom",
  fit: "Fit",
  exposure: "Exposure",
  exposureStops: "Exposure in stops",
  automatic: "Auto",
  curve: "Curve",
  curves: { program: "Job's tone map", filmic: "Filmic", linear: "Linear", reinhard: "Reinhard" },
  layer: "Layer",
  light: "light",
  more: "Analyse",
  histogram: "Histogram",
  histogramSays: (low: number, high: number, bad: number) => `Histogram from 2^${low} to 2^${high}${bad ? `; ${bad} bad pixels` : ""}`,
  falseColor: "False colour of luminance",
  falseLow: "Lowest power of two",
  falseHigh: "Highest power of two",
  markBad: (bad: number) => (bad ? `Mark bad pixels (${bad} bad samples)` : "Mark bad pixels"),
  badList: "Bad samples",
  badAt: (x: number, y: number, kind: string) => `${x}, ${y}: ${kind}`,
  waveform: "Waveform",
  waveformSays: (low: number, high: number) => `Waveform: brightness over the columns of the picture, from 2^${low} to 2^${high}`,
  pin: "Pin to compare",
  pinAgain: "Pin anew",
  unpin: "Unpin",
  pinnedTitle: (title: string, samples: number) => `${title} at ${samples} samples`,
  compare: "Compare with the pinned picture",
  compares: { none: "Off", split: "Split", flicker: "Flicker", difference: "Difference" },
  splitAt: "Split",
  save: "Save picture",
  saveFile: "File",
  saveHelp: "The ending says how: .png is toned by the job's tone map; .exr, .hdr and .npy hold the light itself.",
  saved: (file: string) => `Saved ${file}`,
  exists: "The file exists already.",
  download: "Download what is seen",
  pixel: "Pixel",
  samples: "Samples",
  error: "Error",
  size: (w: number, h: number, samples: number, zoom: string) => `${w} × ${h} pixels, ${count(samples, "sample", "samples")} per pixel; seen at ${zoom}`,
};

export const lights = {
  button: "Lights",
  title: "Light groups",
  active: "Weigh the lights",
  help: "Each is a layer of its own: the picture is shown as if it were brighter, darker or of another colour, without rendering again.",
  toneMap: "The job's tone map knows nothing of it: the filmic curve is shown in its place.",
  on: (name: string) => `Light of ${name}`,
  stops: (name: string) => `Stops of ${name}`,
  stopsNumber: (name: string) => `Stops of ${name} as a number`,
  color: (name: string) => `Colour of ${name}`,
  rest: "all other light",
  reset: "As they are",
  tooMany: (most: number) => `The first ${most} can be weighed here.`,
  saved: "A picture that is saved has the lights as they are weighed here.",
};

export const paths = {
  choose: "Choose “Paths of a pixel” above the picture and click a pixel, or a firefly here.",
  goChoose: "Choose a pixel",
  of: (x: number, y: number) => `Paths of pixel ${x}, ${y}`,
  scene: "The scene as wires with the paths of a pixel",
  list: "Its brightest paths",
  none: "No path brought light.",
  loading: "Looking for its paths…",
  fireflies: "Brightest samples",
  findFireflies: "List",
  refused: (why: string) => `No path of them can be shown: ${why}`,
  noFireflies: "None yet: they are kept from the next restart on.",
  vertex: (i: number) => `Vertex ${i}`,
  sample: (n: number) => `sample ${n}`,
  noWebGl: "Three dimensions need WebGL 2.",
  share: (part: string) => `${part} of the light`,
};

export const heldLight = {
  title: "What the renderer holds",
  photons: "Photons",
  lobes: "Guide at the pixel",
  some: (n: number, all: number, caustic: number) => `${n.toLocaleString("en")} of ${count(all, "photon", "photons")}, ${caustic.toLocaleString("en")} of them of caustics`,
  share: (share: string, most: string) => `It is asked in ${share} of the cases; at most ${most} per steradian.`,
  nothingLearned: "It has learned nothing here yet.",
};

export const space = {
  gizmo: "Handles in the drawing",
  move: "Move",
  turn: "Turn",
  scale: "Scale",
  target: (what: string) => `${what}: drag its handles, or type numbers into its transform`,
  noTarget: "Select an object to move it here.",
};

export const sides = {
  add: "Add",
  with: "Beside the document's own render",
  renderer: "Algorithm",
  same: "the same one",
  set: "With",
  setHelp: "such as renderer.max_depth: 3; several are divided by ;",
  notSet: (text: string) => `"${text}" is not PATH: VALUE`,
  own: "The document's own",
  remove: (what: string) => `Take ${what} away`,
  most: "Four at most stand beside the document's own.",
  curves: "Relative error over time",
  curvesSays: (list: string) => `Relative error over time: ${list}`,
  help: "They follow every edit and take turns with all processors, so their errors are compared at equal time.",
  none: "Renders with other algorithms or members, live beside the document's own, with the course of their errors.",
  picture: (what: string) => `Picture of ${what}`,
};

export const strategies = {
  title: "What each strategy brings",
  help: "Each row has the paths of one length, each picture one strategy of finding them (Veach 1997, figure 10.3).",
  weighted: "As it counts",
  unweighted: "Before weights",
  length: (n: number) => `length ${n}`,
  mean: (y: string) => `mean Y ${y}`,
};

export const views = {
  title: "Views",
  save: "Save this view",
  name: "Name of the view",
  use: (name: string) => `Go to ${name}`,
  remove: (name: string) => `Remove ${name}`,
  none: "None is saved.",
};

export const viewing = { pictures: "Pictures", title: "Pictures" };
