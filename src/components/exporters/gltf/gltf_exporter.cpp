// GltfExporter: exports geometry, simple materials, camera and lights for viewers and modelling programs.

#include <cstring>

#include "components/exporters/asked_members.h"
#include "writer.h"

namespace etendue {

namespace gltf_export {

namespace {

void append_word(std::string& to, std::uint32_t word) {
  char bytes[4];
  std::memcpy(bytes, &word, 4);
  to.append(bytes, 4);
}

}  // namespace

std::string as_uri(const std::string& name) {
  std::string uri;
  for (const char c : name)
    if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
        std::string_view("-._~/").find(c) != std::string_view::npos)
      uri += c;
    else
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return uri;
}

std::string Writer::write(bool binary) {
  const AskedMembers asked;
  binary_ = binary;
  document_["asset"] = {{"version", "2.0"}, {"generator", "Etendue"}};
  document_["scene"] = 0;
  Json roots = nodes_of(*job.scene);
  roots = Json::array({group(still(job.scene->transform, *job.scene), std::move(roots))});
  roots.push_back(camera_node());
  asked.tell(job, exporting);
  document_["scenes"] = Json::array({Json{{"nodes", std::move(roots)}}});
  if (document_.contains("extensionsUsed")) {
    Json used = Json::array();
    for (const auto& [name, is] : document_["extensionsUsed"].items()) used.push_back(name);
    document_["extensionsUsed"] = std::move(used);
  }
  buffer_.resize((buffer_.size() + 3) / 4 * 4);
  if (!buffer_.empty()) {
    document_["buffers"] = Json::array({Json{{"byteLength", buffer_.size()}}});
    if (!binary) document_["buffers"][0]["uri"] = as_uri(exporting.write_beside("data", "bin", std::move(buffer_)));
  }
  if (!binary) return document_.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::string text = document_.dump(-1, ' ', false, Json::error_handler_t::replace), all = "glTF";
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const size_t total = 12 + 8 + text.size() + (buffer_.empty() ? 0 : 8 + buffer_.size());
  if (total > 0xFFFFFFFFu) throw Error("the scene is larger than a .glb can be, 4 GiB: write a .gltf");
  append_word(all, 2);
  append_word(all, std::uint32_t(total));
  append_word(all, std::uint32_t(text.size()));
  all += "JSON" + text;
  if (!buffer_.empty()) {
    append_word(all, std::uint32_t(buffer_.size()));
    all.append("BIN\0", 4) += buffer_;
  }
  return all;
}

}  // namespace gltf_export

namespace {

class GltfExporter final : public Exporter {
 public:
  static void describe(Description<GltfExporter>& d) {
    d.summary(
        "Writes models of glTF 2.0: .gltf with a buffer and images beside it, or .glb, which holds all of them. Shapes become "
        "triangles, "
        "surfaces the nearest of its metallic and rough materials with their extensions; environments and media are noted.",
        "The Khronos Group 2021, glTF 2.0 Specification");
  }
  std::vector<std::string> extensions() const override { return {"glb", "gltf"}; }
  std::string write(const Job& job, Exporting& exporting) const override {
    return gltf_export::Writer(job, exporting).write(exporting.path().ends_with(".glb") || exporting.path().ends_with(".GLB"));
  }
};

const Register<GltfExporter> registered;

}  // namespace

}  // namespace etendue
