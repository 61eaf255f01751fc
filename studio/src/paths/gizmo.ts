// The handles by which an object is moved, turned and scaled in the drawing in three dimensions, and the object's own wires, which follow them.
import type { Change, Triple } from "../model/placing.ts";
import type * as Three from "./three_parts.ts";

export type Mode = "translate" | "rotate" | "scale";

/** What is held by the handles: places in the world [m]. */
export interface Held {
  /** The middle of the object, where it is taken for moving. */
  centre: Triple;
  /** Its own origin, about which it is turned and scaled. */
  origin: Triple;
  /** How its own axes are turned: a quaternion. */
  axes: [number, number, number, number];
  /** Its wires. */
  lines: number[];
}

interface Stage {
  scene: Three.Scene;
  camera: Three.PerspectiveCamera;
  element: HTMLElement;
  orbit: InstanceType<typeof Three.OrbitControls>;
  draw: () => void;
}

export class Gizmo {
  private readonly handle: Three.Group;
  private readonly controls: InstanceType<typeof Three.TransformControls>;
  private readonly lines: Three.LineSegments;
  private held: Held | null = null;
  private start = { position: [0, 0, 0] as Triple };

  /** `moved` is told of each step of a drag, counted from where it began, and of its end. */
  constructor(
    private readonly three: typeof Three,
    private readonly stage: Stage,
    private readonly moved: (change: Change | null, step: "begin" | "drag" | "end") => void,
  ) {
    this.handle = new three.Group();
    this.lines = new three.LineSegments(new three.BufferGeometry(), new three.LineBasicMaterial({ color: "#f0a030" }));
    this.lines.matrixAutoUpdate = false;
    this.controls = new three.TransformControls(stage.camera, stage.element);
    this.controls.setSize(0.8);
    stage.scene.add(this.handle, this.lines, this.controls.getHelper());
    this.controls.addEventListener("change", stage.draw);
    this.controls.addEventListener("dragging-changed", ({ value }) => {
      stage.orbit.enabled = !value;
      if (value) this.moved(null, "begin");
      else {
        this.moved(this.change(), "end");
      }
    });
    this.controls.addEventListener("objectChange", () => {
      this.follow();
      this.moved(this.change(), "drag");
    });
  }

  get dragging(): boolean {
    return this.controls.dragging;
  }

  /** Takes hold of an object, or of none. Not while it is dragged: then the hand says where it is. */
  hold(held: Held | null, mode: Mode): void {
    if (this.dragging) return;
    this.held = held;
    if (!held) this.controls.detach();
    else {
      const at = mode === "translate" ? held.centre : held.origin;
      this.start = { position: at };
      this.handle.position.set(...at);
      this.handle.scale.set(1, 1, 1);
      if (mode === "scale") this.handle.quaternion.set(...held.axes);
      else this.handle.quaternion.set(0, 0, 0, 1);
      this.controls.setMode(mode);
      this.controls.setSpace(mode === "scale" ? "local" : "world");
      this.controls.attach(this.handle);
    }
    this.lines.geometry.dispose();
    this.lines.geometry = new this.three.BufferGeometry();
    this.lines.geometry.setAttribute("position", new this.three.Float32BufferAttribute(held?.lines ?? [], 3));
    this.lines.frustumCulled = false;
    this.follow();
    this.stage.draw();
  }

  dispose(): void {
    this.controls.dispose();
    this.lines.geometry.dispose();
  }

  private change(): Change | null {
    const { position, quaternion, scale } = this.handle;
    if (this.controls.mode === "translate") {
      const [x, y, z] = this.start.position;
      return { kind: "move", by: [position.x - x, position.y - y, position.z - z] };
    }
    if (this.controls.mode === "scale") return { kind: "scale", by: [scale.x, scale.y, scale.z] };
    const half = Math.hypot(quaternion.x, quaternion.y, quaternion.z);
    if (half < 1e-9) return null;
    return { kind: "turn", axis: [quaternion.x / half, quaternion.y / half, quaternion.z / half], angle: 2 * Math.atan2(half, quaternion.w) };
  }

  /** The wires as they are moved: what the handle has done since it was taken. */
  private follow(): void {
    const { Matrix4, Quaternion } = this.three;
    const matrix = this.lines.matrix.identity();
    if (this.held) {
      this.handle.updateMatrix();
      const before = new Matrix4().makeTranslation(...this.start.position);
      if (this.controls.mode === "scale") before.multiply(new Matrix4().makeRotationFromQuaternion(new Quaternion(...this.held.axes)));
      matrix.multiplyMatrices(this.handle.matrix, before.invert());
    }
    this.lines.matrixWorldNeedsUpdate = true;
  }
}
