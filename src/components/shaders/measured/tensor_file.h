#pragma once
// TensorFile: tensor files, in which the EPFL laboratory RGL publishes its measured materials (.bsdf): named arrays of numbers.
//
// Little endian: the twelve bytes "tensor_file\0", two bytes of version (1, 0), a 32-bit count of fields, and for each field a
// 16-bit length and its name, a 16-bit number of dimensions, a byte for the type of its numbers, the 64-bit offset of its data
// in the file and 64 bits for the size of each dimension. The last dimension runs fastest.

#include <cstdint>
#include <string>
#include <vector>

#include "files/regular_file.h"

namespace etendue {

class TensorFile {
 public:
  enum class Type : std::uint8_t {
    uint8 = 1,
    int8,
    uint16,
    int16,
    uint32,
    int32,
    uint64,
    int64,
    float16,
    float32,
    float64,
  };
  struct Field {
    std::string name;
    Type type = Type::float32;
    std::uint64_t offset = 0;
    std::vector<std::uint64_t> shape;
    std::uint64_t count = 0;  ///< of numbers; all of them lie within the file
  };

  /// Reads the list of fields, not their data. This and all other members throw Error, which describes what is wrong but not in
  /// which file.
  explicit TensorFile(const std::string& path);

  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// The field of a name, which must have the given type and number of dimensions and must not be empty.
  const Field& field(const std::string& name, Type, size_t dimensions) const;
  /// Reads a field's numbers; none of them is infinite, not-a-number or so large that products overflow.
  std::vector<float> floats(const Field&);
  std::vector<std::uint8_t> bytes(const Field&);

 private:
  const Field* find(const std::string& name) const;

  RegularFile file_;
  std::vector<Field> fields_;
};

}  // namespace etendue
