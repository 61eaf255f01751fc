#include "tensor_file.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "etendue/core/error.h"

namespace etendue {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are taken from the file as they are");

constexpr std::uint32_t most_fields = 1000;
constexpr float most = 1e12f;  // magnitude of any number
constexpr std::uint16_t most_dimensions = 16, longest_name = 256;

std::uint64_t size_of(TensorFile::Type type) {
  constexpr std::uint8_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
  return sizes[size_t(type)];
}

const char* name_of(TensorFile::Type type) {
  constexpr const char* names[] = {"",      "uint8",  "int8",  "uint16",  "int16",   "uint32",
                                   "int32", "uint64", "int64", "float16", "float32", "float64"};
  return names[size_t(type)];
}

}  // namespace

TensorFile::TensorFile(const std::string& path) : file_(path) {
  const std::uint64_t size = file_.size();
  const auto number = [this]<class T>(T& value) { file_.read(&value, sizeof(T)); };
  char magic[12];
  if (size < 18) throw Error("it is too short for a tensor file");
  file_.read(magic, sizeof magic);
  if (std::memcmp(magic, "tensor_file", 12) != 0) throw Error("it is not a tensor file (those begin with 'tensor_file')");
  std::uint8_t version[2];
  file_.read(version, 2);
  if (version[0] != 1)
    throw Error("it is a tensor file of version " + std::to_string(version[0]) + "." + std::to_string(version[1]) +
                ", only version 1 is known");
  std::uint32_t fields = 0;
  number(fields);
  if (fields > most_fields) throw Error("it claims to hold " + std::to_string(fields) + " fields");

  for (std::uint32_t i = 0; i < fields; ++i) {
    Field field;
    std::uint16_t length = 0, dimensions = 0;
    std::uint8_t type = 0;
    number(length);
    if (length > longest_name) throw Error("the name of field " + std::to_string(i) + " is too long");
    field.name.resize(length);
    file_.read(field.name.data(), length);
    for (char& c : field.name)
      if (c < 32 || c > 126) c = '?';
    const std::string name = "field '" + field.name + "'";
    number(dimensions);
    number(type);
    number(field.offset);
    if (dimensions > most_dimensions) throw Error(name + " has " + std::to_string(dimensions) + " dimensions");
    if (type == 0 || type > std::uint8_t(Type::float64))
      throw Error(name + " has numbers of unknown type " + std::to_string(type));
    field.type = Type(type);
    if (field.offset > size) throw Error(name + " lies behind the end of the file");
    // Divides instead of multiplying, which could overflow: sizes may be anything.
    std::uint64_t room = (size - field.offset) / size_of(field.type);
    field.count = 1;
    for (std::uint16_t k = 0; k < dimensions; ++k) {
      std::uint64_t n = 0;
      number(n);
      field.shape.push_back(n);
      if (n > room) throw Error(name + " claims more numbers than the file holds");
      field.count *= n;
      room = n > 0 ? room / n : room;
    }
    if (has(field.name)) throw Error(name + " is there twice");
    fields_.push_back(std::move(field));
  }
}

const TensorFile::Field* TensorFile::find(const std::string& name) const {
  for (const Field& f : fields_)
    if (f.name == name) return &f;
  return nullptr;
}

const TensorFile::Field& TensorFile::field(const std::string& name, Type type, size_t dimensions) const {
  const Field* f = find(name);
  if (!f) throw Error("it has no field '" + name + "'");
  if (f->type != type) throw Error("field '" + name + "' holds numbers of type " + name_of(f->type) + ", not " + name_of(type));
  if (f->shape.size() != dimensions)
    throw Error("field '" + name + "' has " + std::to_string(f->shape.size()) + " dimensions, not " +
                std::to_string(dimensions));
  if (f->count == 0) throw Error("field '" + name + "' is empty");
  return *f;
}

std::vector<float> TensorFile::floats(const Field& f) {
  std::vector<float> values(f.count);
  file_.seek(f.offset);
  file_.read(values.data(), f.count * sizeof(float));
  for (const float v : values)
    if (!(std::abs(v) <= most)) throw Error("field '" + f.name + "' holds " + std::to_string(v) + ", out of any range");
  return values;
}

std::vector<std::uint8_t> TensorFile::bytes(const Field& f) {
  std::vector<std::uint8_t> values(f.count);
  file_.seek(f.offset);
  file_.read(values.data(), f.count);
  return values;
}

}  // namespace etendue
