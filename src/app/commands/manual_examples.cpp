#include "manual_examples.h"

#include <fmt/format.h>

#include "check/conform/draw.h"
#include "etendue/language/language.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue {
namespace {

#define CAGE                                                                                                       \
  "SubdivisionSurface { positions: [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], " \
  "[1, 1, 1], [-1, 1, 1]] m, indices: [0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7], levels: 5 }"

struct Example {
  const char *name, *part;
};

/// Examples for classes whose defaults look like another class or show nothing.
constexpr Example examples[] = {
    // shaders
    {"Lambertian", "Lambertian { color: srgb(0.75, 0.35, 0.2) }"},
    {"OrenNayar", "OrenNayar { color: srgb(0.75, 0.35, 0.2), roughness: 0.8 }"},
    {"PhongShader", "PhongShader { color: srgb(0.3, 0.05, 0.05), specular: 0.3, exponent: 80 }"},
    {"Conductor", "Conductor { ior: metal(\"Au\"), roughness: 0.25 }"},
    {"Plastic", "Plastic { color: srgb(0.1, 0.3, 0.6) }"},
    {"CoupledMatteSpecular", "CoupledMatteSpecular { color: srgb(0.2, 0.4, 0.15) }"},
    {"WardShader", "WardShader { color: srgb(0.2, 0.2, 0.25), specular: 0.3, roughness_u: 0.06, roughness_v: 0.3 }"},
    {"AshikhminShirley", "AshikhminShirley { color: srgb(0.5, 0.1, 0.05), exponent_u: 1000, exponent_v: 20 }"},
    {"LayeredShader",
     "LayeredShader { top: Dielectric { roughness: 0.1 }, bottom: Conductor { ior: metal(\"Cu\"), roughness: 0.4 } }"},
    {"MixShader",
     "MixShader { first: Lambertian { color: srgb(0.75, 0.35, 0.2) }, second: Conductor {}, amount: CheckerMap { repeat: [16, "
     "8, 1] } }"},
    {"MaskShader",
     "MaskShader { shader: Lambertian { color: srgb(0.75, 0.35, 0.2) }, opacity: CheckerMap { repeat: [16, 8, 1] } }"},
    {"Principled",
     "Principled { base_color: srgb(0.6, 0.05, 0.04), base_metalness: 0.6, coat_weight: 1, specular_roughness: 0.4 }"},
    {"DisneyPrincipled", "DisneyPrincipled { base_color: srgb(0.6, 0.05, 0.04), roughness: 0.3, clearcoat: 1, sheen: 0.5 }"},
    {"DisneyThin", "DisneyThin { base_color: srgb(0.3, 0.5, 0.1), diff_trans: 1, spec_trans: 0.3 }"},
    {"LossyPlastic", "LossyPlastic { color: srgb(0.1, 0.3, 0.6), roughness: 0.3 }"},
    {"SheenShader", "SheenShader { base: Lambertian { color: srgb(0.25, 0.02, 0.08) } }"},
    {"ThinFilm", "ThinFilm { thickness: 420, base_ior: metal(\"Cr\") }"},
    {"Subsurface", "Subsurface { color: srgb(0.9, 0.75, 0.6), mean_free_path: 10 cm }"},
    {"BumpShader",
     "BumpShader { shader: Plastic { color: srgb(0.1, 0.3, 0.6) }, height: NoiseMap { size: 0.15 m }, scale: 0.05 }"},
    {"DiffuseTransmitter", "DiffuseTransmitter { reflectance: srgb(0.2, 0.35, 0.1), transmittance: srgb(0.3, 0.5, 0.1) }"},
    // object maps
    {"ConstantMap", "ConstantMap { value: srgb(0.75, 0.35, 0.2) }"},
    {"CheckerMap", "CheckerMap { first: 0.1, second: 0.8, repeat: [16, 8, 1] }"},
    {"BricksMap", "BricksMap { repeat: [16, 24] }"},
    {"CellularMap", "CellularMap { size: 0.3 m }"},
    {"NoiseMap", "NoiseMap { size: 0.3 m }"},
    {"FbmMap", "FbmMap { size: 0.6 m }"},
    {"TurbulenceMap", "TurbulenceMap { size: 0.6 m }"},
    {"MarbleMap", "MarbleMap { first: srgb(0.15, 0.1, 0.1), second: srgb(0.9, 0.88, 0.85), size: 0.5 m }"},
    {"WoodMap", "WoodMap { first: srgb(0.25, 0.1, 0.03), second: srgb(0.7, 0.42, 0.2), size: 0.25 m }"},
    {"UvTransformMap", "UvTransformMap { map: BricksMap { repeat: [16, 24] }, angle: 30 deg }"},
    {"AddMap", "AddMap { first: NoiseMap { size: 0.3 m }, second: CheckerMap { second: 0.3, repeat: [16, 8, 1] } }"},
    {"MixMap", "MixMap { first: srgb(0.8, 0.2, 0.1), second: srgb(0.1, 0.2, 0.6), amount: FbmMap { size: 0.5 m } }"},
    {"RgbProductMap", "RgbProductMap { first: RgbProductMap { first: NoiseMap { size: 0.3 m } }, factor: [1, 0.5, 0.2] }"},
    {"MultiplyMap", "MultiplyMap { first: NoiseMap { size: 0.3 m }, second: CheckerMap { first: 0.5, repeat: [16, 8, 1] } }"},
    {"TriplanarMap", "TriplanarMap { map: BricksMap { repeat: [4, 8] } }"},
    {"PlanarMap", "PlanarMap { map: BricksMap { repeat: [4, 8] } }"},
    {"SphericalMap", "SphericalMap { map: BricksMap { repeat: [16, 24] } }"},
    {"CylindricalMap", "CylindricalMap { map: BricksMap { repeat: [16, 8] } }"},
    {"SubtractMap", "SubtractMap { first: 0.7, second: NoiseMap { size: 0.3 m } }"},
    {"DivideMap", "DivideMap { first: 0.2, second: NoiseMap { size: 0.3 m } }"},
    {"MaxMap",
     "MaxMap { first: NoiseMap { size: 0.3 m }, second: CheckerMap { first: 0.1, second: 0.5, repeat: [16, 8, 1] } }"},
    {"MinMap",
     "MinMap { first: NoiseMap { size: 0.3 m }, second: CheckerMap { first: 0.9, second: 0.5, repeat: [16, 8, 1] } }"},
    {"PowerMap", "PowerMap { base: NoiseMap { size: 0.3 m }, exponent: 4 }"},
    {"RemapMap", "RemapMap { input: NoiseMap { size: 0.3 m }, from: [0.4, 0.6] }"},
    {"FormulaMap", "FormulaMap { formula: \"0.5 + 0.4 * sin(20 * z + 4 * sin(5 * x))\" }"},
    {"RampMap",
     "RampMap { along: input, input: NoiseMap { size: 0.3 m }, positions: [0.3, 0.5, 0.7], colors: [srgb(0.1, 0.1, 0.5), 0.9, "
     "srgb(0.6, 0.1, 0.05)] }"},
    {"TransformedMap", "TransformedMap { map: WoodMap { size: 0.25 m }, transform: rotate(60 deg, \"x\") }"},
    {"HypertextureMap", "HypertextureMap { first: 0.05, second: 0.9, centre: [0, -0.5, 0.5] m, radius: 1 m }"},
    {"CloudMap",
     "CloudMap { amount: 4, frequency: 3, first: srgb(0.2, 0.35, 0.6), second: 0.95, base: [0, 0, -0.9] m, size: 1.9 m }"},
    {"GridMap",
     "GridMap { resolution: [2, 2, 2], values: [0.8, 0.1, 0.1, 0.1, 0.6, 0.1, 0.1, 0.2, 0.8, 0.8, 0.7, 0.1, 0.1, 0.6, 0.7, "
     "0.7, "
     "0.1, 0.6, 0.9, 0.9, 0.9, 0.2, 0.2, 0.2], placement: translate([-1, -1, -1]) * scale(2) }"},
    {"BlackbodyMap",
     "BlackbodyMap { temperature: RampMap { along: input, input: NoiseMap { size: 0.3 m }, positions: [0, 1], colors: [2000, "
     "9000] "
     "}, normalized: true, factor: 0.8 }"},
    {"AttributeMap", ""},
    {"OperandShader", ""},
    {"PassThrough", ""},
    // cameras
    {"PerspectiveCamera", "PerspectiveCamera { from: [0, -4.6, 1] m, to: [0, 0, 1] m, up: [0, 0, 1], fov: 32 deg }"},
    {"OrthographicCamera", "OrthographicCamera { from: [0.4, -4.6, 1.6] m, to: [0, 0, 1] m, up: [0, 0, 1], width: 2.4 m }"},
    {"SphericalCamera", "SphericalCamera { from: [0.1, -0.4, 1] m, to: [0, 1, 1] m, up: [0, 0, 1] }"},
    {"LensCamera",
     "LensCamera { from: [0, -3.5, 1] m, to: [0, 0, 0.7] m, up: [0, 0, 1], focus_distance: 3.2 m, film_diagonal: 0.036 m }"},
    // media
    {"HomogeneousVolume", "HomogeneousVolume { scattering: 2, absorption: srgb(0.1, 0.5, 0.9) }"},
    {"GridVolume",
     "GridVolume { resolution: [2, 2, 2], density: [0, 1, 1, 0, 1, 0, 0, 1], extinction: 8, albedo: srgb(0.9, 0.6, 0.4), "
     "filter: nearest, placement: translate([-1, -1, -1]) * scale(2) }"},
    {"BlendPhase",
     "BlendPhase { first: HenyeyGreensteinPhase { anisotropy: 0.8 }, second: HenyeyGreensteinPhase { anisotropy: -0.4 }, "
     "amount: 0.3 }"},
    {"TabulatedPhase", "TabulatedPhase { values: [2, 0.2, 1, 8] }"},
    {"MapVolume",
     "MapVolume { density: CloudMap { amount: 4, frequency: 3 }, extinction: 12, albedo: 0.98, placement: translate([0, 0, "
     "-0.3]) "
     "* scale(1.3) }"},
    // objects
    {"Curve", "Curve { points: [[-1, 0, 0], [-0.5, 1, 0.5], [0.5, -1, 0.8], [1, 0, 0.2]] m, radius: [0.12], basis: bezier }"},
    {"ImplicitSurface",
     "ImplicitSurface { formula: \"sin(4 * x) * cos(4 * y) + sin(4 * y) * cos(4 * z) + sin(4 * z) * cos(4 * x)\" }"},
    {"Difference", "Difference { operands: [ Box { size: [2, 2, 2] m }, Sphere { radius: 1.25 m } ] }"},
    {"Intersection", "Intersection { operands: [ Box { size: [2, 2, 2] m }, Sphere { radius: 1.25 m } ] }"},
    {"Union", "Union { operands: [ Box { size: [1.6, 1.6, 1.6] m }, Sphere { radius: 1.05 m } ] }"},
    {"SubdivisionSurface", CAGE},
    {"DisplacedMesh", "DisplacedMesh { surface: " CAGE ", displacement: NoiseMap { size: 0.25 m }, scale: 0.25 m }"},
};

constexpr const char* job = R"(
Job {{
    renderer: {renderer}
    camera:   {camera}
    image:    ImageBuffer {{ width: 160, height: 160 }}
    tone_map: {tone_map}
    scene: EmbreeScene {{ objects: [
        {objects}
    ] }}
}}
)";

constexpr const char* floor_and_lamps = R"(
        Rectangle { corner: [-8, -8, 0] m, edge_u: [16, 0, 0] m, edge_v: [0, 16, 0] m
                    shader: Lambertian { color: CheckerMap { first: 0.35, second: 0.55, repeat: [16, 16, 1] } } }
        Rectangle { corner: [-4.5, -2.5, 3.5] m, edge_u: [1, -1.6, 0.4] m, edge_v: [0.6, 0.6, 1.8] m
                    emission: DiffuseEmission { radiance: 8, sides: "both" } }
        Rectangle { corner: [3, 1, 2] m, edge_u: [0.4, 1, 0] m, edge_v: [-0.4, 0, 1.6] m
                    emission: DiffuseEmission { radiance: 5, sides: "both" } }
        Environment { emission: DiffuseEmission { radiance: 0.25 } })";
constexpr const char* close_camera =
    "PerspectiveCamera { from: [0.6, -5.4, 2.6], to: [0, 0, 0.85], up: [0, 0, 1], fov: 30 deg }";
constexpr const char* path_tracer = "PathTracer { max_depth: 24 }";
constexpr const char* both_ways = "BidirectionalPathTracer { max_depth: 24 }";
constexpr const char* ball = "Sphere { centre: [0, 0, 1.001] m, shader: part }";

/// A room with a lamp, a glass ball and a plastic ball: for renderers, cameras and tone maps. The lamp is large: a path tracer
/// would render the caustic of a small one as fireflies all over the walls.
constexpr const char* room = R"(
        Rectangle { corner: [-1, -1, 0] m, edge_u: [2, 0, 0] m, edge_v: [0, 2, 0] m, shader: Lambertian { color: 0.7 } }
        Rectangle { corner: [-1, -1, 2] m, edge_u: [0, 2, 0] m, edge_v: [2, 0, 0] m, shader: Lambertian { color: 0.7 } }
        Rectangle { corner: [-1, 1, 0] m, edge_u: [2, 0, 0] m, edge_v: [0, 0, 2] m, shader: Lambertian { color: 0.7 } }
        Rectangle { corner: [-1, -1, 0] m, edge_u: [0, 2, 0] m, edge_v: [0, 0, 2] m, shader: Lambertian { color: srgb(0.6, 0.08, 0.06) } }
        Rectangle { corner: [1, -1, 0] m, edge_u: [0, 0, 2] m, edge_v: [0, 2, 0] m, shader: Lambertian { color: srgb(0.1, 0.4, 0.1) } }
        Rectangle { corner: [-0.6, -0.6, 1.98] m, edge_u: [0, 1.2, 0] m, edge_v: [1.2, 0, 0] m
                    emission: DiffuseEmission { radiance: 2.6 } }
        Sphere { centre: [0.45, -0.3, 0.36] m, radius: 0.35 m, shader: Dielectric {} }
        Sphere { centre: [-0.4, 0.3, 0.45] m, radius: 0.44 m, shader: Plastic { color: 0.3 } })";
constexpr const char* room_camera = "PerspectiveCamera { from: [0, -4.6, 1], to: [0, 0, 1], up: [0, 0, 1], fov: 32 deg }";

/// A corner of white walls that shows the light of emission shaders.
constexpr const char* walls = R"(
        Rectangle { corner: [-4, -4, 0] m, edge_u: [8, 0, 0] m, edge_v: [0, 8, 0] m, shader: Lambertian { color: 0.6 } }
        Rectangle { corner: [-4, 1, 0] m, edge_u: [8, 0, 0] m, edge_v: [0, 0, 5] m, shader: Lambertian { color: 0.6 } }
        Sphere { centre: [-0.7, -0.2, 0.35] m, radius: 0.35 m, shader: Lambertian { color: 0.4 } })";
constexpr const char* wall_camera =
    "PerspectiveCamera { from: [0.8, -6.5, 2.2], to: [0, 0, 1.15], up: [0, 0, 1], fov: 34 deg }";

/// The objects for an emission shader: a point light at a height of about 2 m that shines at the wall, an area light there, or
/// an environment.
std::string lamp_objects(const ClassInfo& info, const EmissionShader& emission) {
  if (emission.only_at_infinity())
    return fmt::format(
        "Environment {{ emission: part }}\n        Rectangle {{ corner: [-8, -8, 0] m, edge_u: [16, 0, 0] m, edge_v: "
        "[0, 16, 0] m, shader: Lambertian {{ color: 0.5 }} }}\n        Sphere {{ centre: [0, 0, 1] m, shader: "
        "Conductor {{}} }}");
  if (info.name == "IesEmission" || info.name == "GoniometricEmission")
    return std::string("Point { position: [0, 0.3, 2.2] m, emission: part }") + walls;
  for (const char* name : {"ProjectorEmission", "SpotEmission", "ForeignSpotEmission"})
    if (info.name == name)
      return std::string("Point { transform: translate(0, -1.5 m, 2.2 m) * rotate(-112 deg, \"x\"), emission: part }") + walls;
  return std::string(
             "Rectangle { corner: [-0.3, -0.5, 2.2] m, edge_u: [0, 0.6, 0.2] m, edge_v: [0.6, 0, 0] m, emission: part }") +
         walls;
}

std::string scene_text(const char* renderer, const char* camera, const char* tone_map, const std::string& objects) {
  return fmt::format(fmt::runtime(job), fmt::arg("renderer", renderer), fmt::arg("camera", camera),
                     fmt::arg("tone_map", tone_map), fmt::arg("objects", objects));
}

/// The scene for an object, scaled to the size of a ball of radius 1 on the floor. Nullopt for objects without a finite
/// bounding box.
std::optional<std::string> object_scene(const SceneObject& object) {
  // A texture that shows u and v and their directions: redder with u, greener with v, in 8 x 8 squares.
  constexpr const char* shader =
      "Plastic { color: MultiplyMap { first: UvMap {}, second: CheckerMap { first: 0.45, second: 0.9, repeat: [8, 8, 1] } } }";
  if (object.unbounded())
    return scene_text(
        path_tracer, close_camera, "NoToneMap {}",
        fmt::format("Instance {{ scene: EmbreeScene {{ objects: [ part ] }}, shader: {} }}\n        Sphere {{ centre: "
                    "[0, 0, 1] m, shader: Conductor {{}} }}\n        Environment {{ emission: DiffuseEmission {{ "
                    "radiance: 1 }} }}",
                    shader));
  if (object.infinite() || object.delta() || object.bounds().empty()) return {};
  const Bounds3 box = object.bounds();
  const float scale = 3.3f / length(box.diagonal());
  const Point3 c = box.centre();
  return scene_text(
      path_tracer, close_camera, "NoToneMap {}",
      fmt::format("Instance {{ transform: translate(0, 0, {}) * scale({}) * translate({}, {}, {}), shader: {}, scene: "
                  "EmbreeScene {{ objects: [ part ] }} }}{}",
                  scale * (c.z - box.low.z) + 0.002f, scale, -c.x, -c.y, -c.z, shader, floor_and_lamps));
}

/// Null: no example is listed; "": the class is not shown.
const char* known_example(const ClassInfo& info) {
  for (const Example& e : examples)
    if (info.name == e.name) return e.part;
  return nullptr;
}

}  // namespace

std::string example_of(const ClassInfo& info) {
  const char* known = known_example(info);
  return known ? known : "";
}

std::optional<PictureScene> picture_of(const ClassInfo& info, const conform::Fixtures& fixtures) {
  if (info.abstract()) return {};
  const Registry& registry = Registry::instance();
  const auto is = [&](const char* interface) { return info.is_a(*registry.find(interface)); };
  const bool seen = is("Shader") || is("ObjectMap") || is("EmissionShader") || is("SceneObject") || is("VolumeShader") ||
                    is("PhaseFunction") || is("Renderer") || is("ToneMap") || is("Camera");
  if (!seen || is("Scene") || info.name == "Renderer" || info.name == "Instance") return {};
  const char* known = known_example(info);
  if (known && !*known) return {};
  PictureScene picture;
  std::mt19937_64 random(1);
  if (known) picture.part = known;
  Ref<Component> part;
  if (picture.part.empty()) {
    const conform::Drawn drawn = conform::default_part(info, fixtures, random);
    if (!drawn.part) return {};
    picture.part = drawn.text;
    part = drawn.part;
  } else {
    part = parse_component(picture.part, "the example of " + info.name);
    prepare_tree(*part);
  }
  const char* as_it_is = "NoToneMap {}";
  if (is("Shader"))
    picture.description = scene_text(path_tracer, close_camera, as_it_is, std::string(ball) + floor_and_lamps);
  else if (is("ObjectMap"))
    picture.description =
        scene_text(path_tracer, close_camera, as_it_is,
                   std::string("Sphere { centre: [0, 0, 1] m, shader: Lambertian { color: part } }") + floor_and_lamps);
  else if (is("VolumeShader"))
    picture.description =
        scene_text(path_tracer, close_camera, as_it_is,
                   std::string("Sphere { centre: [0, 0, 1.001] m, shader: PassThrough {}, interior: part }") + floor_and_lamps);
  else if (is("PhaseFunction"))
    picture.description = scene_text(path_tracer, close_camera, as_it_is,
                                     std::string("Sphere { centre: [0, 0, 1.001] m, shader: PassThrough {}, interior: "
                                                 "HomogeneousVolume { scattering: 3, phase: part } }") +
                                         floor_and_lamps);
  else if (is("EmissionShader"))
    picture.description =
        // A delta beam is sampled only from the light source.
        scene_text(info.name == "CollimatedEmission" ? "LightTracer {}" : path_tracer, wall_camera, as_it_is,
                   lamp_objects(info, static_cast<const EmissionShader&>(*part)));
  else if (is("Renderer"))
    picture.description =  // classical ray tracing samples point lights only
        scene_text(
            "part", room_camera, as_it_is,
            std::string(room) + (info.name == "WhittedRenderer"
                                     ? "\n        Point { position: [0, 0, 1.9] m, emission: DiffuseEmission { radiance: 4 } }"
                                     : ""));
  else if (is("ToneMap"))
    picture.description = scene_text(both_ways, room_camera, "part", room);
  else if (is("Camera"))
    picture.description = scene_text(both_ways, "part", as_it_is, room);
  else if (const std::optional<std::string> text = object_scene(static_cast<const SceneObject&>(*part)))
    picture.description = *text;
  else
    return {};
  picture.measured = is("EmissionShader");
  picture.description = "part = " + picture.part + "\n" + picture.description;
  return picture;
}

}  // namespace etendue
