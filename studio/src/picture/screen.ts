// The canvas a picture is drawn on by WebGL 2.
import type { Film } from "./film.ts";
import { fragmentShader, vertexShader } from "./shaders.ts";
import type { Size, View } from "./view.ts";

export interface Look {
  stops: number;
  curve: 0 | 1 | 2 | 3;
  falseColor: boolean;
  falseRange: [number, number];
  compare: 0 | 1 | 2 | 3;
  /** In canvas pixels. */
  split: number;
  markBad: boolean;
  surround: [number, number, number];
}

/** Display values, 8 bits of red, green, blue and alpha a pixel. */
export interface Toned {
  width: number;
  height: number;
  pixels: Uint8Array;
}

export class Screen {
  private readonly gl: WebGL2RenderingContext;
  private readonly program: WebGLProgram;
  private readonly places = new Map<string, WebGLUniformLocation | null>();
  private readonly textures: WebGLTexture[] = [];
  private readonly held: (Film | null)[] = [null, null];
  private heldToned: Toned | null = null;
  private readonly mipmaps: boolean;
  /** Which textures have averages of their pixels. */
  private readonly averaged = [false, false, false];

  /** Throws where the browser has no WebGL 2. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, preserveDrawingBuffer: false });
    if (!gl) throw new Error("no WebGL 2");
    this.gl = gl;
    this.mipmaps = gl.getExtension("EXT_color_buffer_float") !== null || gl.getExtension("EXT_color_buffer_half_float") !== null;
    this.program = this.link();
    gl.useProgram(this.program);
    gl.bindVertexArray(gl.createVertexArray());
    ["picture", "pinned", "toned"].forEach((name, unit) => {
      const texture = gl.createTexture();
      if (!texture) throw new Error("no texture");
      this.textures.push(texture);
      this.bind(unit);
      for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      gl.uniform1i(this.place(name), unit);
    });
  }

  /** Draws a film over a picture of this size (a coarse film has fewer pixels); sends the graphics processor only what has changed. */
  draw(film: Film, size: Size, pinned: Film | null, toned: Toned | null, view: View, look: Look): void {
    const gl = this.gl;
    this.upload(0, film, view.zoom);
    if (pinned) this.upload(1, pinned, view.zoom);
    if (toned) this.uploadToned(toned, view.zoom);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.uniform2f(this.place("pictureSize"), size.width, size.height);
    gl.uniform2f(this.place("scales"), film.scale, pinned?.scale ?? 1);
    gl.uniform2f(this.place("canvasSize"), this.canvas.width, this.canvas.height);
    gl.uniform3f(this.place("view"), view.zoom, view.x, view.y);
    gl.uniform1f(this.place("exposure"), Math.pow(2, look.stops));
    gl.uniform1i(this.place("curve"), look.curve === 3 && !toned ? 0 : look.curve);
    gl.uniform1i(this.place("falseColor"), look.falseColor ? 1 : 0);
    gl.uniform2f(this.place("falseRange"), look.falseRange[0], look.falseRange[1]);
    gl.uniform1i(this.place("compare"), pinned ? look.compare : 0);
    gl.uniform1f(this.place("split"), look.split);
    gl.uniform1i(this.place("markBad"), look.markBad ? 1 : 0);
    gl.uniform3f(this.place("surround"), ...look.surround);
    gl.uniform1f(this.place("seconds"), (performance.now() / 1000) % 3600);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  /** What is on the canvas now, row by row from the upper left: valid right after `draw`. */
  read(): Uint8ClampedArray {
    const { width, height } = this.canvas;
    const lines = new Uint8Array(width * height * 4);
    this.gl.readPixels(0, 0, width, height, this.gl.RGBA, this.gl.UNSIGNED_BYTE, lines);
    const turned = new Uint8ClampedArray(lines.length);
    for (let y = 0; y < height; ++y) turned.set(lines.subarray((height - 1 - y) * width * 4, (height - y) * width * 4), y * width * 4);
    return turned;
  }

  dispose(): void {
    for (const texture of this.textures) this.gl.deleteTexture(texture);
    this.gl.deleteProgram(this.program);
  }

  private upload(unit: 0 | 1, film: Film, zoom: number): void {
    const gl = this.gl;
    const isNew = this.held[unit] !== film;
    const changed = film.takeChanged() ?? (isNew ? { x0: 0, y0: 0, x1: film.width, y1: film.height } : null);
    this.bind(unit);
    if (isNew) {
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, film.width, film.height, 0, gl.RGBA, gl.HALF_FLOAT, film.pixels);
      this.held[unit] = film;
    } else if (changed) {
      const from = changed.y0 * film.width * 4;
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, changed.y0, film.width, changed.y1 - changed.y0, gl.RGBA, gl.HALF_FLOAT,
        film.pixels.subarray(from, changed.y1 * film.width * 4));
    }
    this.filter(unit, zoom, isNew || changed !== null);
  }

  private uploadToned(toned: Toned, zoom: number): void {
    const gl = this.gl;
    this.bind(2);
    const isNew = toned !== this.heldToned;
    if (isNew) gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, toned.width, toned.height, 0, gl.RGBA, gl.UNSIGNED_BYTE, toned.pixels);
    this.heldToned = toned;
    this.filter(2, zoom, isNew);
  }

  /** Large pixels are squares; small ones are averaged. */
  private filter(unit: number, zoom: number, changed: boolean): void {
    const gl = this.gl;
    const small = zoom < 1 && this.mipmaps;
    if (small && (changed || !this.averaged[unit])) {
      gl.generateMipmap(gl.TEXTURE_2D);
      this.averaged[unit] = true;
    } else if (changed) {
      this.averaged[unit] = false;
    }
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, small ? gl.LINEAR_MIPMAP_LINEAR : gl.NEAREST);
  }

  private bind(unit: number): void {
    this.gl.activeTexture(this.gl.TEXTURE0 + unit);
    this.gl.bindTexture(this.gl.TEXTURE_2D, this.textures[unit] ?? null);
  }

  private place(name: string): WebGLUniformLocation | null {
    let found = this.places.get(name);
    if (found === undefined) this.places.set(name, (found = this.gl.getUniformLocation(this.program, name)));
    return found;
  }

  private link(): WebGLProgram {
    const gl = this.gl;
    const program = gl.createProgram();
    if (!program) throw new Error("no program");
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]] as const) {
      const shader = gl.createShader(kind);
      if (!shader) throw new Error("no shader");
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader) ?? "shader");
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "link");
    return program;
  }
}
