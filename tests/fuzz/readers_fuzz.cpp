// Arbitrary bytes as a file of another program: it is read, or refused with Errors that give the location, without any other
// failure.
//
//     readers_fuzz --reader=pbrt --beside=FOLDER [libFuzzer's options] corpus/…
//
// Each input becomes a file in a folder of this process's own, beside copies of the files in FOLDER, which it may name. The
// result is used as the program would use it: meshes and volumes are read, the description is written. fuzz.py makes corpora
// and runs all readers.

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>

#include "components/objects/meshes/mesh_data.h"
#include "components/volumes/volume_grid.h"
#include "describe/expansion.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "render/checkpoint.h"
#include "render/import_job.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void stop(const std::string& why) {
  std::fprintf(stderr, "readers_fuzz: %s\n", why.c_str());
  std::abort();
}

void check(const Error& error) {
  if (*error.what() == 0) stop("an error without words");
  if (!error.location.known()) stop(std::string("an error without a place: ") + error.what());
  if (show(error).empty()) stop("an error that shows nothing");
}

fs::path folder;  // private to this process

void visit(Component& part, std::set<const Component*>& seen) {
  if (!seen.insert(&part).second) return;
  if (part.class_info().name == "TriangleMesh") {
    const Value file_value = get(part, "file"), name_value = get(part, "part");
    const FilePath* const file = file_value.as<FilePath>();
    const std::string* const name = name_value.as<std::string>();
    if (file && !file->empty()) try {
        read_mesh(file->resolved(), name ? *name : "");
      } catch (const Error&) {  // a render reports its location
      }
  }
  for (Component* const inner : components_of(part)) visit(*inner, seen);
}

void import(const std::string& path) {
  try {
    const ImportedJob imported = import_job(*importer_of(path), path, {});
    for (const Error& note : imported.notes) check(note);
    for (const std::string& file : files_named_by(*imported.job)) {
      const fs::path real = fs::weakly_canonical(fs::absolute(file));
      if (real.string().rfind(folder.string() + "/", 0) != 0) stop("it leaves its folder: " + file);
    }
    if (write_description(*imported.job).empty()) stop("a description without words");
    std::set<const Component*> seen;
    visit(*imported.job, seen);
  } catch (const Errors& errors) {
    if (errors.errors.empty()) stop("no errors in Errors");
    for (const Error& error : errors.errors) check(error);
  } catch (const Error& error) {
    check(error);
  }
}

/// Reads the first meshes of a file.
void mesh(const std::string& path) {
  for (const char* number : {"0", "1"}) try {
      read_mesh(path, number);
    } catch (const Error& error) {
      if (*error.what() == 0) stop("an error without words");
    }
}

void volume(const std::string& path) {
  try {
    const VolumeGrid grid = read_volume_grid(path);
    float value[3];
    for (const float x : {-1e30f, -0.5f, 0.3f, 1.0f, 7.5f})
      for (const Beyond beyond : {Beyond::clamp, Beyond::repeat, Beyond::mirror, Beyond::empty, Beyond::cut})
        grid.look_up({x, 0.5f, 1 - x}, VoxelFilter::trilinear, beyond, value);
  } catch (const Error& error) {
    if (*error.what() == 0) stop("an error without words");
  }
}

struct Reader {
  std::string_view name;
  const char *written, *read;  ///< the file that is made from an input, and the file that is read, which names the former
  void (*run)(const std::string& path);
};

constexpr Reader readers[] = {
    {"mitsuba", "input.xml", "input.xml", import}, {"mitsuba_included", "input.xml", "scene.xml", import},
    {"pbrt", "input.pbrt", "input.pbrt", import},  {"pbrt_included", "input.pbrt", "scene.pbrt", import},
    {"gltf", "input.gltf", "input.gltf", import},  {"glb", "input.glb", "input.glb", import},
    {"obj", "input.obj", "input.obj", import},     {"mtl", "input.mtl", "model.obj", import},
    {"stl", "input.stl", "input.stl", import},     {"off", "input.off", "input.off", import},
    {"ply", "input.ply", "input.ply", import},     {"serialized", "input.serialized", "input.serialized", mesh},
    {"vol", "input.vol", "input.vol", volume},     {"npy", "input.npy", "input.npy", volume},
    {"nvdb", "input.nvdb", "input.nvdb", volume},
};
const Reader* reader = nullptr;

std::string option(int count, char** arguments, std::string_view name) {
  for (int i = 1; i < count; ++i)
    if (std::string_view(arguments[i]).rfind(name, 0) == 0) return arguments[i] + name.size();
  return {};
}

void remove_folder() {
  std::error_code none;
  fs::remove_all(folder, none);
}

}  // namespace
}  // namespace etendue

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  using namespace etendue;
  const std::string name = option(*count, *arguments, "--reader="), beside = option(*count, *arguments, "--beside=");
  for (const Reader& r : readers)
    if (r.name == name) reader = &r;
  if (!reader) {
    std::fputs("--reader= needs one of:", stderr);
    for (const Reader& r : readers) std::fprintf(stderr, " %s", std::string(r.name).c_str());
    std::fputs("\n", stderr);
    std::exit(2);
  }
  std::string own = (fs::temp_directory_path() / "readers_fuzz.XXXXXX").string();
  if (!::mkdtemp(own.data())) stop("no folder can be made in " + own);
  folder = fs::canonical(own);
  std::atexit(remove_folder);
  if (!beside.empty()) fs::copy(beside, folder, fs::copy_options::recursive);
  fs::current_path(folder);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace etendue;
  std::ofstream(reader->written, std::ios::binary).write(reinterpret_cast<const char*>(data), std::streamsize(size));
  reader->run(reader->read);
  return 0;
}
