#pragma once
// Small .glb files, each array in a buffer view of its own, and the messages that reading them gives.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "etendue/importer.h"
#include "etendue/render/job.h"

namespace etendue::glb_test {

using Json = nlohmann::json;

/// A .glb file, from JSON and the bytes of its buffer views.
struct File {
  Json json{{"asset", {{"version", "2.0"}}}, {"nodes", {{{"mesh", 0}}}}, {"scenes", {{{"nodes", {0}}}}}, {"scene", 0}};
  std::string binary;

  /// Appends bytes at an offset that is a multiple of four, and returns the offset.
  size_t put(const std::string& bytes) {
    binary.resize((binary.size() + 3) / 4 * 4);
    binary += bytes;
    return binary.size() - bytes.size();
  }
  size_t add(const char* list, Json element) {
    json[list].push_back(std::move(element));
    return json[list].size() - 1;
  }
  size_t view(const std::string& bytes) {
    const size_t offset = put(bytes);
    return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
  }
  std::string text() const {
    Json all = json;
    if (!all.contains("buffers")) all["buffers"].push_back({});
    all["buffers"][0]["byteLength"] = binary.size();
    std::string head = all.dump(), whole = "glTF";
    head.resize((head.size() + 3) / 4 * 4, ' ');
    const auto word = [&](size_t x) { whole.append(reinterpret_cast<const char*>(&x), 4); };
    word(2);
    word(28 + head.size() + binary.size());
    word(head.size());
    whole += "JSON" + head;
    word(binary.size());
    return whole + std::string("BIN\0", 4) + binary;
  }
};

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string told(const std::string& path, bool& refused) {
  Importing importing(path, {});
  std::string all;
  refused = false;
  try {
    importer_of(path)->import(importing);
    for (const Error& note : importing.notes()) all += std::string(note.what()) + "\n";
  } catch (const Error& error) {
    EXPECT_STREQ(error.location.file, path.c_str());
    refused = true;
    all = error.what();
  }
  return all;
}
inline std::string error_of(const std::string& path) {
  bool refused = false;
  const std::string all = told(path, refused);
  return refused ? all : "";
}

}  // namespace etendue::glb_test
