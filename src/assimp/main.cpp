// etendue_assimp FILE [--unit=METRES] [--note=TEXT ...] [FOLDER ...]: reads a model in one of the formats that Assimp supports
// and writes it as .glb to standard output; errors are written to standard error. It is a separate program, so that a crash of
// the library ends nothing else, and it may open only files in the model's folder and the given folders.

#include <assimp/config.h>
#include <assimp/postprocess.h>

#include <assimp/Importer.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "apart/limit_process.h"
#include "ase_indices.h"
#include "convert.h"
#include "limits.h"
#include "prepared.h"
#include "second_reading.h"

namespace {

using namespace etendue::assimp_helper;

int run(const std::string& path, std::vector<std::string> folders) {
  double unit = 0;
  std::vector<std::string> notes;
  constexpr std::string_view unit_option = "--unit=", note_option = "--note=";
  for (; !folders.empty() && folders[0].starts_with("--"); folders.erase(folders.begin())) {
    if (folders[0].starts_with(unit_option)) unit = std::strtod(folders[0].c_str() + unit_option.size(), nullptr);
    if (folders[0].starts_with(note_option)) notes.push_back(folders[0].substr(note_option.size()));
  }
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  folders.push_back(folder.empty() ? "." : folder);
  constexpr std::uint64_t mega = 1 << 20;
  etendue::apart::limit_process(1024 * mega + 64 * size,
                                20 + size / (2 * mega));  // the libraries themselves map some hundred megabytes
  if (const std::string wrong = wrong_ase_index(path); !wrong.empty()) {
    std::fprintf(stderr, "%s\n", wrong.c_str());
    return 1;
  }
  const SecondReading second;
  Assimp::Importer importer;
  auto* const files = new FilesWithin(folders);  // the importer deletes it
  importer.SetIOHandler(files);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);  // else it invents meshes for models without any
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 60);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                                                     aiProcess_GenUVCoords | aiProcess_TransformUVCoords |
                                                     aiProcess_JoinIdenticalVertices | aiProcess_ValidateDataStructure);
  if (!scene || !scene->mRootNode) {
    const std::string said = clean(importer.GetErrorString());
    if (said.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // the library catches the exception
    if (said.find("mNumMeshes is 0") != std::string::npos || said.find("File came out empty") != std::string::npos)
      throw std::runtime_error("Assimp finds nothing in it that can be seen");
    std::fprintf(stderr, "%s\n", said.c_str());
    return 1;
  }
  Glb glb;
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  notes.insert(notes.end(), left_out().begin(), left_out().end());
  for (const std::string& note : notes) glb.note(note);
  for (const std::string& file : files->opened()) glb.json["asset"]["extras"]["files"].push_back(clean(file));
  convert(*scene, glb, ending.empty() ? ending : ending.substr(1), unit);
  const std::uint64_t digest = glb.digest();
  if (second.here()) {
    second.tell(digest);
    return 0;
  }
  const std::optional<std::uint64_t> again = second.told();
  if (again != digest) {
    std::fprintf(stderr,
                 "%s: the file is damaged, or meets a fault of the library, and may then well be right. Another format of the "
                 "same model may be read, best glTF (.glb)\n",
                 again ? "what Assimp, which is other people's code, makes of it differs from one reading to the next"
                       : "Assimp, which is other people's code, read it once and failed at the second reading");
    return 1;
  }
  return glb.write(1) ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "etendue_assimp FILE [--unit=METRES] [--note=TEXT ...] [FOLDER ...]\n");
    return 2;
  }
  try {
    return run(arguments[1], {arguments + 2, arguments + count});
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "it needs more memory than a file of its size may\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}
