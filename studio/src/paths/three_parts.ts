// What is taken of three.js.
export {
  BufferGeometry, Color, Float32BufferAttribute, Group, Line, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, PerspectiveCamera, Raycaster,
  Scene, SphereGeometry, Vector2, Vector3, WebGLRenderer, ArrowHelper,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
