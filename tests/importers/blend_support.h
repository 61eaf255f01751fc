#pragma once
// A small file of Blender: one triangle with vertex colours. Such a file is memory blocks, each with the structure of its
// contents, and a description of all structures ("DNA").

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace etendue::blend_test {

template <class T>
void append(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The structures and their members, each a type, a name and its size in bytes.
struct Member {
  const char *type, *name;
  std::uint16_t size;
};
inline const std::vector<std::pair<const char*, std::vector<Member>>>& structures() {
  static const std::vector<std::pair<const char*, std::vector<Member>>> all{
      {"ID", {{"char", "name[8]", 8}}},
      {"ListBase", {{"void", "*first", 8}, {"void", "*last", 8}}},
      {"Scene",
       {{"ID", "id", 8},
        {"Object", "*camera", 8},
        {"World", "*world", 8},
        {"Base", "*basact", 8},
        {"Collection", "*master_collection", 8},
        {"ListBase", "base", 16}}},
      {"Base", {{"Base", "*next", 8}, {"Base", "*prev", 8}, {"Object", "*object", 8}}},
      {"Object",
       {{"ID", "id", 8},
        {"int", "type", 4},
        {"float", "obmat[4][4]", 64},
        {"float", "parentinv[4][4]", 64},
        {"char", "parsubstr[4]", 4},
        {"Object", "*parent", 8},
        {"void", "*data", 8}}},
      {"Mesh",
       {{"ID", "id", 8},
        {"int", "totface", 4},
        {"int", "totedge", 4},
        {"int", "totvert", 4},
        {"MFace", "*mface", 8},
        {"MVert", "*mvert", 8},
        {"MCol", "*mcol", 8},
        {"Material", "**mat", 8}}},
      {"MFace", {{"int", "v1", 4}, {"int", "v2", 4}, {"int", "v3", 4}, {"int", "v4", 4}, {"int", "mat_nr", 4}}},
      {"MVert", {{"float", "co[3]", 12}, {"float", "no[3]", 12}}},
      {"MCol", {{"char", "a", 1}, {"char", "r", 1}, {"char", "g", 1}, {"char", "b", 1}}}};
  return all;
}

inline std::uint32_t structure(const std::string& name) {
  std::uint32_t i = 0;
  while (structures()[i].first != name) ++i;
  return i;
}

/// The description of the structures: the names of members, the types with their sizes, and the structures by indices of these.
inline std::string dna() {
  std::vector<std::string> names, types;
  std::map<std::string, std::uint16_t> sizes{{"char", 1}, {"int", 4}, {"float", 4}};
  const auto index = [](std::vector<std::string>& list, const std::string& text) {
    std::uint16_t i = 0;
    while (i < list.size() && list[i] != text) ++i;
    if (i == list.size()) list.push_back(text);
    return i;
  };
  std::string made;
  for (const auto& [name, members] : structures()) {
    append(made, index(types, name));
    append(made, std::uint16_t(members.size()));
    for (const Member& m : members) {
      append(made, index(types, m.type));
      append(made, index(names, m.name));
      sizes[name] = std::uint16_t(sizes[name] + m.size);
    }
  }
  std::string all = "SDNA";
  const auto list = [&](const char* tag, const std::vector<std::string>& texts) {
    all += tag;
    append(all, std::uint32_t(texts.size()));
    for (const std::string& text : texts) all += text + '\0';
    all.resize((all.size() + 3) / 4 * 4);
  };
  list("NAME", names);
  list("TYPE", types);
  all += "TLEN";
  for (const std::string& type : types) append(all, sizes[type]);
  all.resize((all.size() + 3) / 4 * 4);
  all += "STRC";
  append(all, std::uint32_t(structures().size()));
  return all + made;
}

/// A triangle with these three corners, whose vertices have a colour of the bytes 255, 0 and 128.
inline std::string triangle(const std::vector<float>& corners) {
  enum Address : std::uint64_t { none, scene = 0x100, base, object, mesh, faces, vertices, colors };
  std::string file = "BLENDER-v269";
  const auto block = [&](const char* code, const char* of, Address address, std::uint32_t count, const std::string& content) {
    file.append(code, 4);
    append(file, std::uint32_t(content.size()));
    append(file, std::uint64_t(address));
    append(file, of ? structure(of) : 0);
    append(file, count);
    file += content;
  };
  const auto name = [](std::string text) {
    text.resize(8);
    return text;
  };
  std::string b = name("SCs");
  for (const Address a : {none, none, none, none, base, base}) append(b, std::uint64_t(a));
  block("SC\0\0", "Scene", scene, 1, b);
  b.clear();
  for (const Address a : {none, none, object}) append(b, std::uint64_t(a));
  block("DATA", "Base", base, 1, b);
  b = name("OBp");
  append(b, 1);                                                           // a mesh
  for (int i = 0; i < 32; ++i) append(b, i % 16 % 5 == 0 ? 1.0f : 0.0f);  // two matrices of identity
  append(b, 0);
  for (const Address a : {none, mesh}) append(b, std::uint64_t(a));
  block("OB\0\0", "Object", object, 1, b);
  b = name("MEp");
  for (const int n : {1, 0, 3}) append(b, n);
  for (const Address a : {faces, vertices, colors, none}) append(b, std::uint64_t(a));
  block("ME\0\0", "Mesh", mesh, 1, b);
  b.clear();
  for (const int n : {0, 1, 2, 0, 0}) append(b, n);
  block("DATA", "MFace", faces, 1, b);
  b.clear();
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) append(b, corners[3 * i + k]);
    for (size_t k = 0; k < 3; ++k) append(b, 0.0f);
  }
  block("DATA", "MVert", vertices, 3, b);
  b.clear();
  for (int i = 0; i < 4; ++i) b += std::string("\xff\xff\0\x80", 4);
  block("DATA", "MCol", colors, 4, b);
  block("DNA1", nullptr, none, 1, dna());
  block("ENDB", nullptr, none, 0, "");
  return file;
}

}  // namespace etendue::blend_test
