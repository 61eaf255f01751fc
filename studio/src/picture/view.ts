// Where a picture lies on its canvas: zoom and pan. Lengths are in the canvas's own pixels unless they say otherwise.

export interface View {
  /** Canvas pixels per pixel of the picture. */
  zoom: number;
  /** Where the picture's upper left corner is. */
  x: number;
  y: number;
}

export interface Size {
  width: number;
  height: number;
}

export const leastZoom = 1 / 32;
export const mostZoom = 256;

/** All of the picture, as large as the canvas lets it; whole multiples where pixels are larger than those of the screen. */
export function fit(picture: Size, canvas: Size, margin = 16): View {
  const whole = Math.min((canvas.width - 2 * margin) / picture.width, (canvas.height - 2 * margin) / picture.height);
  return centred(picture, canvas, Math.min(mostZoom, Math.max(leastZoom, whole)));
}

export function centred(picture: Size, canvas: Size, zoom: number): View {
  return {
    zoom,
    x: Math.round((canvas.width - picture.width * zoom) / 2),
    y: Math.round((canvas.height - picture.height * zoom) / 2),
  };
}

/** Zooms about a place of the canvas, which stays where it is. */
export function zoomAbout(view: View, factor: number, x: number, y: number): View {
  const zoom = Math.min(mostZoom, Math.max(leastZoom, view.zoom * factor));
  const ratio = zoom / view.zoom;
  return { zoom, x: x - (x - view.x) * ratio, y: y - (y - view.y) * ratio };
}

/** The place in the picture, in its pixels, under a place of the canvas. */
export function toPicture(view: View, x: number, y: number): [number, number] {
  return [(x - view.x) / view.zoom, (y - view.y) / view.zoom];
}

export function toCanvas(view: View, x: number, y: number): [number, number] {
  return [view.x + x * view.zoom, view.y + y * view.zoom];
}
