// The texts about pictures.
import { count } from "./count.ts";

export const picture = {
  canvas: "The picture. Arrow keys move the pixel cursor, plus and minus zoom, F fits to the window, E and Shift+E change the exposure.",
  none: "No picture yet.",
  noWebGl: "This browser cannot show the picture: it needs WebGL 2.",
  toolbar: "Picture",
  mouse: "Tools",
  modes: {
    look: "Pan and zoom",
    pick: "Select objects",
    orbit: "Orbit the camera: drag; Shift+drag pans, Ctrl+drag or the wheel dollies",
    fly: "Fly the camera: W A S D, Q E; drag to look around",
    crop: "Crop: render only a rectangle",
    paths: "Show the paths of a pixel: click it",
  },
  /** Shown beside the icons until they are known. */
  modeNames: { look: "Pan and zoom", pick: "Select", orbit: "Orbit", fly: "Fly", crop: "Crop", paths: "Paths" },
  hideNames: "Hide the names of the tools",
  wholePicture: "Remove the crop",
  frame: "Frame the selected object",
  zoom: "Zoom",
  fit: "Fit to window",
  exposure: "Exposure",
  exposureStops: "Exposure in stops",
  automatic: "Auto",
  one: "Actual pixels",
  curve: "Tone curve",
  curves: { program: "Job's tone map", filmic: "Filmic", linear: "Linear", reinhard: "Reinhard" },
  layer: "Layer",
  light: "Picture",
  more: "Analyse",
  histogram: "Histogram",
  histogramSays: (low: number, high: number, bad: number) => `Histogram from 2^${low} to 2^${high}${bad ? `; ${bad} NaN or infinite pixels` : ""}`,
  falseColor: "False colour (luminance)",
  falseLow: "Lowest power of two",
  falseHigh: "Highest power of two",
  markBad: (bad: number) => (bad ? `Mark NaN and infinite samples (${bad})` : "Mark NaN and infinite samples"),
  badList: "NaN and infinite samples",
  badAt: (x: number, y: number, kind: string) => `${x}, ${y}: ${kind}`,
  waveform: "Waveform",
  waveformSays: (low: number, high: number) => `Waveform: brightness over the columns of the picture, from 2^${low} to 2^${high}`,
  spectrum: {
    title: (x: number, y: number) => `Spectrum of pixel ${x}, ${y}`,
    noError: "W/(m² sr nm); its error is not known.",
    error: (renders: number) => `W/(m² sr nm) ± one standard error, from ${renders} renders of this pixel`,
    measure: "Measure the error",
    measuring: "Measuring …",
    measureHelp: "Render this pixel several times by itself: the spread gives the standard error of each band",
  },
  pin: "Pin for comparison",
  pinAgain: "Replace the pinned picture",
  unpin: "Unpin",
  pinnedTitle: (title: string, samples: number) => `${title} at ${samples} samples`,
  compare: "Compare with the pinned picture",
  compares: { none: "Off", split: "Split", flicker: "Flicker", difference: "Difference" },
  splitAt: "Split",
  save: "Save picture",
  saveFile: "File",
  saveHelp: "The extension selects the format: .png is tone mapped by the job's tone map; .exr, .hdr and .npy store linear values.",
  saved: (file: string) => `Saved ${file}`,
  exists: "The file already exists.",
  download: "Download as displayed",
  pixel: "Pixel",
  samples: "Samples",
  error: "Error",
  size: (w: number, h: number, samples: number, zoom: string) => `${w} × ${h} pixels, ${count(samples, "sample", "samples")} per pixel; zoom ${zoom}`,
};

export const lights = {
  button: "Lights",
  title: "Light groups",
  active: "Adjust lights",
  help: "Scale the brightness and colour of each light group without rendering again.",
  toneMap: "The job's tone map cannot be applied to adjusted lights: the filmic curve is used instead.",
  on: (name: string) => `Show ${name}`,
  stops: (name: string) => `Brightness of ${name} in stops`,
  stopsNumber: (name: string) => `Brightness of ${name}, number of stops`,
  color: (name: string) => `Colour of ${name}`,
  rest: "other lights",
  reset: "Reset",
  tooMany: (most: number) => `Only the first ${most} can be adjusted here.`,
  saved: "The picture is saved with the lights as adjusted here.",
};

export const paths = {
  choose: "Choose a pixel of the picture, or list the brightest samples below.",
  goChoose: "Choose a pixel",
  of: (x: number, y: number) => `Paths of pixel ${x}, ${y}`,
  scene: "Wireframe of the scene with the paths of a pixel",
  list: "Brightest paths of a pixel",
  none: "No path of this pixel carries light.",
  loading: "Computing the paths…",
  fireflies: "Brightest samples",
  findFireflies: "List",
  refused: (why: string) => `The paths of these samples cannot be shown: ${why}`,
  noFireflies: "None yet: they are recorded after the next restart.",
  vertex: (i: number) => `Vertex ${i}`,
  sample: (n: number) => `sample ${n}`,
  noWebGl: "The 3D view needs WebGL 2.",
  share: (part: string) => `${part} of the light`,
};

export const heldLight = {
  title: "Photons and path guiding",
  photons: "Show photons",
  lobes: "Show the guiding distribution at the pixel",
  some: (n: number, all: number, caustic: number) => `${n.toLocaleString("en")} of ${count(all, "photon", "photons")}, ${caustic.toLocaleString("en")} of them caustic`,
  share: (share: string, most: string) => `Sampled with probability ${share}; its pdf is at most ${most} per steradian.`,
  nothingLearned: "The guiding distribution has not been learned here yet.",
};

export const space = {
  gizmo: "Transform handles",
  move: "Move",
  turn: "Rotate",
  scale: "Scale",
  target: (what: string) => `${what}: drag a handle, or edit its transform in the panel`,
  noTarget: "Select an object to move it here.",
};

export const sides = {
  add: "Add",
  with: "Add another render",
  renderer: "Algorithm",
  same: "as in the document",
  set: "Settings",
  setHelp: "For example renderer.max_depth: 3; separate several with ;",
  notSet: (text: string) => `"${text}" must have the form PATH: VALUE`,
  own: "Document",
  remove: (what: string) => `Remove ${what}`,
  most: "At most four can be added.",
  curves: "Relative error over time",
  curvesSays: (list: string) => `Relative error over time: ${list}`,
  help: "All renders follow every edit. They use all processors in turn, so that their errors can be compared at equal time.",
  none: "Add a render with another algorithm or other settings to compare it with the document's render.",
  picture: (what: string) => `Picture of ${what}`,
};

export const strategies = {
  title: "Contribution of each sampling strategy",
  help: "A row for each path length, a picture for each sampling strategy (Veach 1997, figure 10.3).",
  weighted: "With MIS weights",
  unweighted: "Without weights",
  length: (n: number) => `length ${n}`,
  mean: (y: string) => `mean Y ${y}`,
};

export const views = {
  title: "Saved views",
  save: "Save this view",
  name: "Name of the view",
  use: (name: string) => `Go to ${name}`,
  remove: (name: string) => `Remove ${name}`,
  none: "No saved views.",
};

export const viewing = { pictures: "Pictures", title: "Pictures" };
