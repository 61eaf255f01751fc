// Import: the content of another program's file, as an object of a scene.

#include "import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <unordered_set>

#include "describe/expansion.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "formats/permissions.h"
#include "render/imported.h"

namespace etendue {
namespace {

// The file is read when the object is prepared. Its objects become the objects of this scene, so that code which visits the
// objects of scenes finds them. Rays are intersected by another scene over the same objects (`over_`).
class Import final : public Scene {
 public:
  static void describe(Description<Import>& d) {
    d.summary(
         "What a file of another program holds, at any place in a scene: a model of glTF, OBJ, FBX and others. Its camera and "
         "what "
         "lies at infinity are left out; what it could not express is told when it is read.")
        .member<&Import::file>("file", "", "the model (glTF, OBJ, PLY, FBX, USD, …), or a scene of another program", required,
                               Effect::rebuild)
        .member<&Import::time>("time", "s", "of what moves in it", Effect::rebuild);
  }

  bool find_nearest(const Ray& ray, Hit& hit) const override { return over_->nearest(ray, hit); }
  bool find_any(const Ray& ray) const override { return over_->any(ray); }
  void find_all(const Ray& ray, HitList& list) const override { over_->all(ray, list); }

  void prepare() override {
    if (!over_ || read_ != file.resolved() || read_at_ != time) read();
    Scene::prepare();
  }

  /// Reads the file. Its objects become this scene's objects, not prepared.
  void read_objects() {
    const std::string path = file.resolved();
    if (file.empty()) fail("file", "a file is needed");
    const Ref<Importer> importer = importer_of(path);
    if (!importer)
      fail("file", fmt::format("'{}' is of no format that is imported; files of these endings are: .{}", path,
                               fmt::join(imported_extensions(), ", .")));
    ImportOptions options = import_permissions();
    options.time = time;
    Importing importing(path, options);
    const Ref<Component> read = read_by(*importer, importing);
    if (options.strict && !importing.notes().empty()) throw Errors(importing.notes());
    for (const Error& note : importing.notes()) warn(note.what(), note.location);
    const Ref<Job> job = ref_cast<Job>(read);
    const Ref<Scene> scene = job ? job->scene : ref_cast<Scene>(read);
    if (!scene) fail("file", "'" + path + "' holds nothing that can be seen");
    objects.clear();
    for (const Ref<SceneObject>& object : scene->objects)
      if (!object->infinite() || object->delta()) objects.push_back(object);
    if (objects.size() < scene->objects.size())
      warn("what lies at infinity in '" + path + "' is left out", location_of("file"));
  }

  FilePath file;
  double time = 0;

 protected:
  void build(std::span<const SceneObject* const>) override {
    over_->objects = objects;
    over_->prepare();
  }

 private:
  /// Reads the file. Errors of the file as a whole, such as a missing file, are reported at the location of the member `file`.
  Ref<Component> read_by(const Importer& importer, Importing& importing) const {
    try {
      return imported(importer, importing);
    } catch (const Error& error) {
      if (error.location.line > 0) throw;
      const std::string what = error.what(), path = file.resolved();
      fail("file", what.find(path) == std::string::npos ? "'" + path + "': " + what : what);
    }
  }

  void read() {
    read_objects();
    over_ = ref_cast<Scene>(Registry::instance().create(imported_structure));
    for (const Ref<SceneObject>& object : objects) prepare_tree(*object);
    read_ = file.resolved();
    read_at_ = time;
  }

  Ref<Scene> over_;
  std::string read_;
  double read_at_ = 0;
};

// `objects` come from the file. They are removed from the members, so that the Import itself is saved and not its content.
[[maybe_unused]] const bool registered = [] {
  static RegistrationNode node{typeid(Import), parent_type<Import>(),
                               [](ClassInfo& info) {
                                 std::erase_if(info.members, [](const Member& m) { return m.name == "objects"; });
                                 Description<Import> d(info);
                                 Import::describe(d);
                                 d.finish();
                               },
                               [](const ClassInfo&) { return Ref<Component>(make<Import>()); }, nullptr};
  enlist(node);
  return true;
}();

}  // namespace

void read_imports(const Component& root) {
  std::unordered_set<const Component*> seen{&root};
  std::vector<const Component*> left{&root};
  while (!left.empty()) {
    const Component& part = *left.back();
    left.pop_back();
    const auto visit = [&](const Component* c) {
      if (c && seen.insert(c).second) left.push_back(c);
    };
    for (Component* inner : components_of(part)) {
      if (auto* import = dynamic_cast<Import*>(inner); import && !seen.contains(inner)) {
        import->read_objects();
        for (const Ref<SceneObject>& object : import->objects) visit(object.get());
      }
      visit(inner);
    }
  }
}

}  // namespace etendue
