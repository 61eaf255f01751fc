// The drawing in three dimensions: the scene as wires, paths as lines, vertices as points that can be clicked.
import type * as Three from "./three_parts.ts";
import { Gizmo } from "./gizmo.ts";
import type { Change } from "../model/placing.ts";
import { lobesObject, photonsObject, type Lobes, type Photons } from "./light.ts";
import { places, triple, type ReplayedPath, type Triple, type Wireframe } from "./model.ts";

export interface Chosen {
  path: number;
  vertex: number;
}

/** Colours of paths, the brightest first (Wong 2011, "Points of view: color blindness"). */
export const pathColors = ["#e69f00", "#56b4e9", "#009e73", "#f0e442", "#d55e00", "#cc79a7", "#0072b2", "#999999"];

export class Space {
  private readonly renderer: Three.WebGLRenderer;
  private readonly scene: Three.Scene;
  private readonly camera: Three.PerspectiveCamera;
  private readonly controls: InstanceType<typeof Three.OrbitControls>;
  private readonly paths: Three.Group;
  private readonly light: Three.Group;
  private wires: Three.LineSegments | null = null;
  private size = 1;
  private frame = 0;
  private readonly resize: ResizeObserver;
  readonly gizmo: Gizmo;

  constructor(
    private readonly three: typeof Three,
    private readonly box: HTMLElement,
    private readonly choose: (what: Chosen) => void,
    moved: (change: Change | null, step: "begin" | "drag" | "end") => void,
  ) {
    this.renderer = new three.WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.scene = new three.Scene();
    this.camera = new three.PerspectiveCamera(40, 1, 0.001, 10000);
    this.paths = new three.Group();
    this.light = new three.Group();
    this.scene.add(this.paths, this.light);
    box.append(this.renderer.domElement);
    this.renderer.domElement.setAttribute("aria-hidden", "true"); // the list beside it tells the same
    this.controls = new three.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw());
    const stage = { scene: this.scene, camera: this.camera, element: this.renderer.domElement, orbit: this.controls, draw: () => this.draw() };
    this.gizmo = new Gizmo(three, stage, moved);
    this.resize = new ResizeObserver(() => this.fit());
    this.resize.observe(box);
    this.renderer.domElement.addEventListener("click", (e) => this.click(e));
    this.fit();
  }

  background(color: string): void {
    this.scene.background = new this.three.Color(color);
    this.draw();
  }

  /** Shows wires; `look`: from where all of them are seen. */
  show(wireframe: Wireframe, dark: boolean, look: boolean): void {
    const { BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments, Vector3 } = this.three;
    if (this.wires) this.scene.remove(this.wires);
    this.wires?.geometry.dispose();
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(wireframe.lines, 3));
    geometry.computeBoundingSphere();
    this.wires = new LineSegments(geometry, new LineBasicMaterial({ color: dark ? "#5d6b78" : "#9aa7b3", transparent: true, opacity: 0.6 }));
    this.scene.add(this.wires);
    const sphere = geometry.boundingSphere;
    this.size = Math.max(1e-6, sphere && Number.isFinite(sphere.radius) && wireframe.lines.length ? sphere.radius : 1);
    if (!look) return this.draw();
    const centre = sphere && wireframe.lines.length ? sphere.center : new Vector3();
    const from = wireframe.camera?.from;
    this.camera.near = this.size / 1000;
    this.camera.far = this.size * 100;
    if (wireframe.camera?.up) this.camera.up.set(...wireframe.camera.up);
    this.controls.target.copy(centre);
    const away = 3.1 / Math.min(1, this.camera.aspect); // so that a sphere about the scene is seen whole
    if (from) {
      // From where the render looks, a little aside and farther away, so that its paths are seen from without.
      const back = new Vector3(...from).sub(centre);
      back.applyAxisAngle(this.camera.up, 0.35).setLength(Math.max(back.length(), this.size * away));
      this.camera.position.copy(centre).add(back);
    } else this.camera.position.copy(centre).add(new Vector3(1, 0.7, 1.6).setLength(this.size * away));
    this.controls.update();
    this.draw();
  }

  drawPaths(paths: ReplayedPath[], chosen: Chosen | null): void {
    const { BufferGeometry, Float32BufferAttribute, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, SphereGeometry } = this.three;
    this.paths.clear();
    const ball = new SphereGeometry(this.size * 0.014, 12, 8);
    paths.forEach((path, i) => {
      const isChosen = !chosen || chosen.path === i;
      const color = pathColors[i % pathColors.length];
      for (const vertices of [path.vertices, path.light_vertices]) {
        const points: Triple[] = places(vertices, this.size * 0.5);
        if (points.length < 2) continue;
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new Float32BufferAttribute(points.flat(), 3));
        this.paths.add(new Line(geometry, new LineBasicMaterial({ color, transparent: true, opacity: isChosen ? 1 : 0.15 })));
      }
      path.vertices.forEach((vertex, v) => {
        const at = triple(vertex.position);
        if (!at || !isChosen || vertex.kind === "escaped") return;
        const here = chosen?.path === i && chosen.vertex === v;
        const mesh = new Mesh(ball, new MeshBasicMaterial({ color: here ? "#ffffff" : color }));
        mesh.position.set(...at);
        if (here) mesh.scale.setScalar(1.8);
        mesh.userData = { path: i, vertex: v };
        this.paths.add(mesh);
        const normal = triple(vertex.normal);
        if (here && normal && vertex.kind !== "camera") {
          const { ArrowHelper, Vector3 } = this.three;
          this.paths.add(new ArrowHelper(new Vector3(...normal), new Vector3(...at), this.size * 0.15, 0xffffff, this.size * 0.03));
        }
      });
    });
    this.draw();
  }

  /** Photons, and what a guide has learned at a place. */
  drawLight(photons: Photons | null, lobes: Lobes | null): void {
    this.light.traverse((o) => "geometry" in o && (o.geometry as Three.BufferGeometry).dispose());
    this.light.clear();
    if (photons) this.light.add(...photonsObject(this.three, photons, this.size));
    if (lobes) this.light.add(...lobesObject(this.three, lobes, this.size));
    this.draw();
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.resize.disconnect();
    this.gizmo.dispose();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.domElement.remove();
  }

  private click(event: MouseEvent): void {
    const bounds = this.renderer.domElement.getBoundingClientRect();
    const at = new this.three.Vector2(((event.clientX - bounds.left) / bounds.width) * 2 - 1, 1 - ((event.clientY - bounds.top) / bounds.height) * 2);
    const ray = new this.three.Raycaster();
    ray.setFromCamera(at, this.camera);
    const hit = ray.intersectObjects(this.paths.children).find((h) => "vertex" in h.object.userData);
    if (hit) this.choose(hit.object.userData as Chosen);
  }

  private fit(): void {
    const { clientWidth: w, clientHeight: h } = this.box;
    if (!w || !h) return;
    this.renderer.setSize(w, h, false);
    this.camera.aspect = w / h;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  private draw(): void {
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.renderer.render(this.scene, this.camera);
    });
  }
}
