// etendue_draco: reads compressed meshes from its standard input, a file, and writes their triangles to standard output (the
// formats are in components/importers/gltf/compressed/draco_wire.h); errors are written to standard error. It is a separate
// program, so that a crash of the library ends nothing else, and a few bytes that claim gigabytes cannot use more memory than
// this process is allowed.

#include <draco/compression/decode.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "apart/limit_process.h"
#include "components/importers/gltf/compressed/draco_wire.h"

namespace {

using namespace etendue::draco_wire;

[[noreturn]] void refuse(const std::string& reason) { throw std::runtime_error(reason); }

/// Reads the request from its beginning.
class Asked {
 public:
  explicit Asked(std::span<const char> bytes) : rest_(bytes) {}
  bool at_end() const { return rest_.empty(); }
  std::span<const char> take(std::uint64_t count) {
    if (count > rest_.size()) refuse("what is asked ends too early");
    const std::span<const char> taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  template <class T>
  T value() {
    T v;
    std::memcpy(&v, take(sizeof v).data(), sizeof v);
    return v;
  }

 private:
  std::span<const char> rest_;
};

std::span<const char> standard_input() {
  struct stat status{};
  if (::fstat(0, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0) refuse("its standard input is no file");
  void* const bytes = ::mmap(nullptr, size_t(status.st_size), PROT_READ, MAP_PRIVATE, 0, 0);
  if (bytes == MAP_FAILED) refuse(std::strerror(errno));
  return {static_cast<const char*>(bytes), size_t(status.st_size)};
}

/// Buffers output and writes it in blocks; throws std::bad_alloc beyond `most` bytes.
class Out {
 public:
  explicit Out(std::uint64_t most) : room_(most) {}
  void bytes(const void* from, size_t count) {
    if (count > room_) throw std::bad_alloc();
    room_ -= count;
    kept_.append(static_cast<const char*>(from), count);
    if (kept_.size() >= 1 << 16) flush();
  }
  template <class T>
  void value(const T& v) {
    bytes(&v, sizeof v);
  }
  void flush() {
    for (size_t done = 0; done < kept_.size();) {
      const ssize_t written = ::write(1, kept_.data() + done, kept_.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) refuse("what was read cannot be written");
      done += size_t(written);
    }
    kept_.clear();
  }

 private:
  std::uint64_t room_;
  std::string kept_;
};

template <class T>
void write_numbers(const draco::PointAttribute& attribute, std::uint32_t vertices, Out& out) {
  T numbers[256] = {};
  const size_t width = attribute.num_components();
  if (!attribute.is_mapping_identity() && attribute.indices_map_size() < vertices) refuse("its vertices are not all there");
  for (draco::PointIndex i(0); i < vertices; ++i) {
    const draco::AttributeValueIndex value = attribute.mapped_index(i);
    if (value.value() >= attribute.size() || !attribute.ConvertValue(value, std::int8_t(width), numbers))
      refuse("the numbers of vertex " + std::to_string(i.value()) + " are not there");
    out.bytes(numbers, width * sizeof(T));
  }
}

/// Size of a number, by glTF's code of its component type.
std::uint64_t bytes_of(std::uint32_t component) {
  switch (component) {
    case 5120:
    case 5121: return 1;
    case 5122:
    case 5123: return 2;
    case 5125:
    case 5126: return 4;
    default: refuse("numbers of type " + std::to_string(component) + " are unknown");
  }
}

void write_attribute(const draco::PointAttribute& attribute, std::uint32_t component, std::uint32_t vertices, Out& out) {
  switch (component) {
    case 5120: return write_numbers<std::int8_t>(attribute, vertices, out);
    case 5121: return write_numbers<std::uint8_t>(attribute, vertices, out);
    case 5122: return write_numbers<std::int16_t>(attribute, vertices, out);
    case 5123: return write_numbers<std::uint16_t>(attribute, vertices, out);
    case 5125: return write_numbers<std::uint32_t>(attribute, vertices, out);
    default: return write_numbers<float>(attribute, vertices, out);
  }
}

std::unique_ptr<draco::Mesh> decode(std::span<const char> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  const auto kind = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (!kind.ok()) refuse(kind.status().error_msg_string());
  if (kind.value() != draco::TRIANGULAR_MESH) refuse("it holds points, and no triangles");
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) refuse(mesh.status().error_msg_string());
  return std::move(mesh).value();
}

void answer(Asked& asked, Out& out) {
  const auto head = asked.value<MeshAsked>();
  std::vector<AttributeAsked> wanted;
  for (std::uint64_t i = 0; i < head.attributes; ++i) wanted.push_back(asked.value<AttributeAsked>());
  const std::unique_ptr<draco::Mesh> mesh = decode(asked.take(head.bytes));
  const std::uint32_t vertices = mesh->num_points(), triangles = mesh->num_faces();
  out.value(MeshMade{triangles, vertices});
  std::vector<const draco::PointAttribute*> attributes;
  for (const AttributeAsked& one : wanted) {
    attributes.push_back(mesh->GetAttributeByUniqueId(one.id));
    if (!attributes.back()) refuse("there is no attribute " + std::to_string(one.id) + " in it");
    const std::uint64_t width = attributes.back()->num_components();
    if (width > 127) refuse("attribute " + std::to_string(one.id) + " is too wide");
    out.value(AttributeMade{width, width * bytes_of(one.component)});
  }
  for (draco::FaceIndex i(0); i < triangles; ++i) {
    const draco::Mesh::Face& face = mesh->face(i);
    const std::uint32_t corners[3] = {face[0].value(), face[1].value(), face[2].value()};
    out.value(corners);
  }
  for (size_t i = 0; i < wanted.size(); ++i) write_attribute(*attributes[i], wanted[i].component, vertices, out);
}

void run() {
  const std::span<const char> input = standard_input();
  // In practice Draco encodes a triangle in a byte or more, and in a hundredth of a byte for regular meshes; decoding takes up
  // to 300 bytes per triangle.
  constexpr std::uint64_t mega = 1 << 20;
  const std::uint64_t memory = 384 * mega + 1024 * input.size();
  etendue::apart::limit_process(memory, 5 + input.size() / (100 << 10));
  Asked asked(input);
  Out out(memory);
  while (!asked.at_end()) answer(asked, out);
  out.flush();
}

}  // namespace

int main() {
  try {
    run();
    return 0;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "it needs more memory than so few bytes may\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}
