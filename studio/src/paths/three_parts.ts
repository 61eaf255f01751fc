// What is taken of three.js.
export {
  BufferGeometry, Color, DoubleSide, Float32BufferAttribute, Group, Line, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, Object3D, PerspectiveCamera, Points, PointsMaterial,
  Quaternion, Raycaster, Scene, SphereGeometry, Vector2, Vector3, WebGLRenderer, ArrowHelper,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
export { TransformControls } from "three/examples/jsm/controls/TransformControls.js";
