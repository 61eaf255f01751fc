#include "render/import_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "etendue/render/job.h"
#include "language/loader.h"
#include "language/writer.h"
#include "render/imported.h"

namespace etendue {

namespace {

/// The bounding box of all finite objects, which are prepared for this as they will be in the scene.
Bounds3 prepared_bounds(const Scene& scene) {
  Bounds3 all;
  for (const Ref<SceneObject>& object : scene.objects) {
    prepare_tree(*object);
    if (!object->infinite() && !object->unbounded()) all.add(object->bounds());
  }
  return all;
}

bool emits(const Scene& scene) {
  for (const Ref<SceneObject>& object : scene.objects) {
    if (object->luminaire()) return true;
    if (const Scene* inner = scene_within(*object); inner && emits(*inner)) return true;
  }
  return false;
}

DoubleVector3 sum(double a, const DoubleVector3& x, double b, const DoubleVector3& y, double c, const DoubleVector3& z) {
  return {a * x.x + b * y.x + c * z.x, a * x.y + b * y.y + c * z.y, a * x.z + b * y.z + c * z.z};
}

/// A camera that sees the whole scene from the front, a little from the right and from above. "Front" is +z if y is up, as in
/// glTF and most models, and -y if z is up, as in CAD.
Ref<Camera> camera_on(const Scene& scene, const Importing& importing) {
  const Bounds3 bounds = prepared_bounds(scene);
  const Location at = importing.at();
  if (bounds.empty()) throw Error("there is nothing in it to be seen", at);
  const Point3 centre = bounds.centre();
  const double radius = std::max(double(length(bounds.diagonal())) / 2, 1e-6);
  const DoubleVector3 up = importing.up;
  const DoubleVector3 front = up.z != 0 ? DoubleVector3{0, -up.z, 0} : DoubleVector3{0, 0, 1};
  const DoubleVector3 right = cross(up, front);
  constexpr double field_of_view = 40;  // [deg]
  constexpr double sideways = 0.55, upwards = 0.4;
  const double distance = 1.03 * radius / std::sin(field_of_view / 2 * pi / 180);
  const double scale = distance / std::sqrt(1 + sideways * sideways + upwards * upwards);
  const DoubleVector3 back = sum(scale, front, scale * sideways, right, scale * upwards, up);
  Ref<Component> camera = importing.make("PerspectiveCamera", at);
  const auto point = [](double x, double y, double z) { return Numbers{{x, y, z}, 1, Dimension::none}; };
  const double x = double(centre.x), y = double(centre.y), z = double(centre.z);
  set_member(*camera, "from", point(x + back.x, y + back.y, z + back.z), at);
  set_member(*camera, "to", point(x, y, z), at);
  set_member(*camera, "up", point(up.x, up.y, up.z), at);
  set_member(*camera, "fov", field_of_view, at);
  return ref_cast<Camera>(camera);
}

/// Adds a studio environment: a dim room, a large soft lamp above on the left behind the camera and a small one on the right.
/// Shapes are distinguishable, shadows are soft, and metals reflect something.
void add_light(Scene& scene, const Importing& importing) {
  constexpr const char* studio =
      R"etd(EnvironmentEmission { radiance: MultiplyMap { first: illuminant("D65"), second: FormulaMap { formula: ")etd"
      "0.35 + 0.45 * smoothstep(0.42, 0.9, v)"
      " + 14 * exp(-144 * (u - 0.6) * (u - 0.6) - 60 * (v - 0.78) * (v - 0.78))"
      " + 2.5 * exp(-192 * (u - 0.27) * (u - 0.27) - 80 * (v - 0.62) * (v - 0.62))"
      R"etd(" } } })etd";
  const Location at = importing.at();
  Ref<Component> room = importing.make("Environment", at);
  set(*room, "emission", Value(parse_component(studio, "light added to " + importing.path()), at));
  // The environment's own axes have +y up and +z to the front.
  if (importing.up.z != 0) set(*room, "transform", Value(Transform::rotate(importing.up.z * double(pi) / 2, {1, 0, 0}), at));
  scene.objects.push_back(ref_cast<SceneObject>(room));
}

/// Adds light if the scene has none, unless `-D light=no`.
void light_if_dark(Scene& scene, Importing& importing, bool lit) {
  const std::string wanted = importing.parameter("light").value_or(lit ? "no" : "yes");
  if (wanted != "yes" && wanted != "no") throw Error("'light' is yes or no", importing.at());
  if (wanted == "no") return;
  add_light(scene, importing);
  if (!lit) importing.inexact("it has no lights: a studio's are added (-D light=no: none)", importing.at());
}

Ref<Job> job_around(const Ref<Scene>& scene, Importing& importing) {
  Ref<Component> job = importing.make("Job", importing.at());
  const Ref<Camera> camera = camera_on(*scene, importing);
  importing.inexact("it has no camera: one that sees all of it is added", importing.at());
  light_if_dark(*scene, importing, importing.is_lit.value_or(emits(*scene)));
  set(*job, "camera", Value(Ref<Component>(camera)));
  set(*job, "scene", Value(Ref<Component>(scene)));
  return ref_cast<Job>(job);
}

/// The result of an importer, completed to a job that can be rendered.
Ref<Job> whole_job(const Ref<Component>& read, Importing& importing) {
  if (const Ref<Job> job = ref_cast<Job>(read)) {
    if (importing.is_lit) light_if_dark(*job->scene, importing, *importing.is_lit);
    return job;
  }
  const Ref<Scene> scene = ref_cast<Scene>(read);
  if (!scene) throw Error("the importer gave neither a Job nor a Scene", importing.at());
  return job_around(scene, importing);
}

/// A file of another program as an include statement uses it.
class ImportedFile final : public language::OtherFile {
 public:
  ImportedFile(const Importer& importer, const std::string& path, const ImportOptions& options,
               const std::vector<std::pair<std::string, std::string>>& parameters)
      : importing_(path, options, parameters), read_(imported(importer, importing_)) {
    for (const auto& [name, value] : parameters) parameters_.push_back(name);
  }

  Ref<Component> job() override { return whole_job(read_, importing_); }
  // Messages about parameters that the file does not have are left out: unused_parameters returns these parameters.
  std::vector<Error> notes() override {
    std::vector<Error> all = importing_.notes();
    std::erase_if(all, [&](const Error& note) {
      return std::ranges::any_of(parameters_, [&](const std::string& name) { return is_about(name, note); });
    });
    return all;
  }
  std::vector<std::string> unused_parameters() override {
    std::vector<std::string> unused = parameters_;
    const std::vector<Error> all = importing_.notes();
    std::erase_if(unused, [&](const std::string& name) {
      return std::ranges::none_of(all, [&](const Error& note) { return is_about(name, note); });
    });
    return unused;
  }
  std::vector<std::pair<std::string, Value>> names(bool with_main_parts) override {
    std::vector<std::pair<std::string, Value>> all;
    std::set<std::string> taken;
    if (with_main_parts) all = main_parts();
    for (const auto& [name, value] : all) taken.insert(name);
    for (const auto& [given, part] : language::Writer(false, {}).named_parts(*read_)) {
      std::string name = given;
      for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", given, i);
      all.emplace_back(name, Value(Ref<Component>(const_cast<Component*>(part))));  // it is a part of read_
    }
    return all;
  }

 private:
  std::vector<std::pair<std::string, Value>> main_parts() const {
    const Ref<Job> job = ref_cast<Job>(read_);
    const Ref<Scene> scene = job ? job->scene : ref_cast<Scene>(read_);
    std::vector<std::pair<std::string, Value>> all;
    const auto add = [&](const char* name, const Ref<Component>& part) {
      if (part) all.emplace_back(name, Value(part));
    };
    add("scene", scene);
    Value::List objects;
    if (scene)
      for (const Ref<SceneObject>& object : scene->objects) objects.emplace_back(Ref<Component>(object));
    all.emplace_back("objects", Value(std::move(objects)));
    if (!job) return all;
    add("camera", job->camera);
    add("renderer", job->renderer);
    add("image", job->image);
    return all;
  }

  static bool is_about(const std::string& parameter, const Error& note) {
    return note.location.file == intern("-D " + parameter);
  }

  Importing importing_;
  Ref<Component> read_;
  std::vector<std::string> parameters_;
};

}  // namespace

const language::OtherFiles& imported_files() {
  static const language::OtherFiles files{
      [](const std::string& path) { return bool(importer_of(path)); }, imported_extensions,
      [](const std::string& path, const ImportOptions& options,
         const std::vector<std::pair<std::string, std::string>>& parameters) -> std::unique_ptr<language::OtherFile> {
        return std::make_unique<ImportedFile>(*importer_of(path), path, options, parameters);
      }};
  return files;
}

ImportedJob import_job(const Importer& importer, const std::string& path, const LoadOptions& options) {
  Importing importing(path, options.import, options.defines);
  ImportedJob result{whole_job(imported(importer, importing), importing), {}};
  result.notes = importing.notes();
  if (options.import.strict && !result.notes.empty()) throw Errors(std::move(result.notes));
  return result;
}

// ---- jobs of files
// -----------------------------------------------------------------------------------------------------------

Ref<Job> load_job(const std::string& path, const LoadOptions& options) {
  try {
    if (const Ref<Importer> importer = importer_of(path)) {
      const ImportedJob imported = import_job(*importer, path, options);
      for (const Error& note : imported.notes) warn(note.what(), note.location);
      return imported.job;
    }
    language::Loader loader(options, &imported_files());
    loader.add_file(path);
    return ref_cast<Job>(loader.result(true));
  } catch (const std::bad_alloc&) {
    throw Error("there is not enough memory for what it describes", {intern(path), 0, 0});
  }
}

Ref<Job> load_job_text(const std::string& text, const std::string& name, const std::string& folder,
                       const LoadOptions& options) {
  language::Loader loader(options, &imported_files());
  loader.add_text(text, name, folder);
  return ref_cast<Job>(loader.result(true));
}

}  // namespace etendue
