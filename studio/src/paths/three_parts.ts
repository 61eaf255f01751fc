// What is taken of three.js.
export {
  BufferGeometry, Color, Float32BufferAttribute, Group, Line, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, PerspectiveCamera,
  Quaternion, Raycaster, Scene, SphereGeometry, Vector2, Vector3, WebGLRenderer, ArrowHelper,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
export { TransformControls } from "three/examples/jsm/controls/TransformControls.js";
