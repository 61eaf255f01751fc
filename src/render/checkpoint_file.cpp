// Checkpoints as files.
//
// All numbers are in the machine's byte order (little endian). The preamble consists of 64-bit words: name and version of the
// format, the length of the file, the lengths of the seven parts that follow, the hash of the first part, and the hash of all
// preceding words. The parts are: a header (see `header` below), the states of the image, the renderer and the layers of
// surfaces, and the same three states from before a short pass, which may be empty. The last word is the hash of everything
// before it.

#include <fmt/format.h>
#include <signal.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <istream>
#include <iterator>
#include <ostream>

#include "checkpoint.h"
#include "core/hash.h"
#include "files/bytes.h"
#include "files/regular_file.h"
#include "files/whole_file.h"

namespace etendue {

namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::uint64_t name_of_format = 0x54504b4345445445;  // "ETDECKPT"
constexpr std::uint64_t version_of_format = 3;
constexpr size_t parts = 7;  // the header, a State, and the State before a short pass
using Bytes = std::vector<std::byte>;

std::uint64_t hash_of(std::span<const std::byte> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

struct Preamble {
  std::uint64_t name = name_of_format, version = version_of_format, length = 0;
  std::array<std::uint64_t, parts> lengths{};
  std::uint64_t header_check = 0, check = 0;

  std::uint64_t hash() const { return hash_of(std::as_bytes(std::span(this, 1)).first(sizeof *this - sizeof check)); }
};
static_assert(sizeof(Preamble) == 8 * (3 + parts + 2));

Bytes header(const Checkpoint& c) {
  ByteWriter w;
  w.text(c.version);
  w.value(c.seed);
  w.value(c.samples_per_pass);
  w.value(c.samples_wanted);
  w.value(c.seconds);
  w.value(std::uint64_t(c.done.size()));
  for (const IndexRange& r : c.done) {
    w.value(r.begin);
    w.value(r.end);
  }
  w.text(c.identity.text);
  w.value(std::uint64_t(c.identity.files.size()));
  for (const Identity::File& file : c.identity.files) {
    w.text(file.name);
    w.value(file.size);
    w.value(file.hash);
  }
  w.text(c.image);
  w.text(c.tone_map);
  w.value(std::uint64_t(c.outputs.size()));
  for (const std::string& output : c.outputs) w.text(output);
  w.value(std::uint64_t(c.metadata.size()));
  for (const auto& [key, text] : c.metadata) {
    w.text(key);
    w.text(text);
  }
  w.value(std::uint8_t(c.before_short_pass.has_value()));
  return std::move(w.bytes);
}

/// Returns whether there is a state from before a short pass. The program version is checked before the rest is read.
bool read_header(const Bytes& bytes, Checkpoint& c) {
  ByteReader r(bytes, "its header");
  c.version = r.text();
  const std::string own = ETENDUE_VERSION ", " + std::string(abi_string());
  if (c.version != own) throw Error(fmt::format("it is of version {}, this program is {}", c.version, own));
  c.seed = r.value<std::uint64_t>();
  c.samples_per_pass = r.value<std::uint32_t>();
  c.samples_wanted = r.value<std::uint32_t>();
  c.seconds = r.value<double>();
  std::uint32_t last = 0;
  for (auto n = r.count(8); n > 0; --n) {
    IndexRange range;
    range.begin = r.value<std::uint32_t>();
    range.end = r.value<std::uint32_t>();
    if (range.begin >= range.end || (!c.done.empty() && range.begin <= last))
      throw Error("its ranges of samples are not sorted");
    last = range.end;
    c.done.push_back(range);
  }
  if (c.samples_per_pass == 0 || !(c.seconds >= 0)) throw Error("its header is invalid");
  c.identity.text = r.text();
  for (auto n = r.count(24); n > 0; --n) {
    Identity::File& file = c.identity.files.emplace_back();
    file.name = r.text();
    file.size = r.value<std::uint64_t>();
    file.hash = r.value<std::uint64_t>();
  }
  c.image = r.text();
  c.tone_map = r.text();
  for (auto n = r.count(8); n > 0; --n) c.outputs.push_back(r.text());
  for (auto n = r.count(16); n > 0; --n) {
    const std::string key = r.text();
    c.metadata[key] = r.text();
  }
  const bool before = r.value<std::uint8_t>() != 0;
  if (!r.at_end()) throw Error("its header is longer than it should be");
  return before;
}

/// Reads from a RegularFile, or from another source with its functions.
template <class Source>
Checkpoint read(Source& file, bool states) {
  const std::uint64_t size = file.size();
  Preamble p;
  const auto get = [&](void* to, std::uint64_t bytes) { file.read(to, bytes); };
  if (size < sizeof p.name) throw Error("it is not a checkpoint");
  get(&p.name, sizeof p.name);
  if (p.name != name_of_format) throw Error("it is not a checkpoint");
  if (size < sizeof p) throw Error(fmt::format("it is cut short, to {} bytes", size));
  file.seek(0);
  get(&p, sizeof p);
  if (p.version != version_of_format)
    throw Error(fmt::format("it is of format {}, this program reads {}", p.version, version_of_format));
  if (p.check != p.hash()) throw Error("it is damaged: its beginning is not what was written");
  if (size < p.length) throw Error(fmt::format("it is cut short: {} of {} bytes are there", size, p.length));
  if (size > p.length) throw Error(fmt::format("it is damaged: {} bytes where {} were written", size, p.length));

  std::array<Bytes, parts> bytes;
  for (size_t i = 0; i < (states ? parts : 1); ++i) {
    if (p.lengths[i] > size) throw Error("it is damaged: its parts are longer than the whole");
    bytes[i].resize(p.lengths[i]);
    get(bytes[i].data(), p.lengths[i]);
  }
  if (p.header_check != hash_of(bytes[0])) throw Error("it is damaged: its header is not what was written");
  if (states) {
    Hash hash;
    hash.add(std::as_bytes(std::span(&p, 1)));
    for (const Bytes& part : bytes) hash.add(part);
    std::uint64_t written = 0;
    get(&written, sizeof written);
    if (written != hash.value()) throw Error("it is damaged: its contents are not what was written");
  }

  Checkpoint c;
  const bool before = read_header(bytes[0], c);
  c.state = {std::move(bytes[1]), std::move(bytes[2]), std::move(bytes[3])};
  if (before) c.before_short_pass = Checkpoint::State{std::move(bytes[4]), std::move(bytes[5]), std::move(bytes[6])};
  return c;
}

Checkpoint read(const std::string& path, bool states) {
  std::error_code error;
  const auto refuse = [&](const std::string& reason) {
    return Error(fmt::format("cannot use the checkpoint '{}': {}", path, reason));
  };
  if (!std::filesystem::exists(path, error) && !error) throw refuse("there is no such file");
  try {
    RegularFile file(path);
    return read(file, states);
  } catch (const Error& e) {
    throw refuse(e.what());
  } catch (const std::bad_alloc&) {
    throw refuse(no_memory_to_read);
  }
}

}  // namespace

namespace {

/// The bytes of a checkpoint, as pieces that refer to it and to the header, preamble and hash stored here.
class Pieces {
 public:
  explicit Pieces(const Checkpoint& c) : head_(header(c)) {
    static const Checkpoint::State nothing;
    const Checkpoint::State &now = c.state, &before = c.before_short_pass ? *c.before_short_pass : nothing;
    const std::array<const Bytes*, parts> bytes = {&head_,        &now.image,       &now.renderer,   &now.surfaces,
                                                   &before.image, &before.renderer, &before.surfaces};
    preamble_.length = sizeof preamble_ + sizeof sum_;
    for (size_t i = 0; i < parts; ++i) {
      preamble_.lengths[i] = bytes[i]->size();
      preamble_.length += bytes[i]->size();
    }
    preamble_.header_check = hash_of(head_);
    preamble_.check = preamble_.hash();
    all_.push_back(std::as_bytes(std::span(&preamble_, 1)));
    for (const Bytes* part : bytes) all_.push_back(*part);
    Hash hash;
    for (const auto& piece : all_) hash.add(piece);
    sum_ = hash.value();
    all_.push_back(std::as_bytes(std::span(&sum_, 1)));
  }
  Pieces(const Pieces&) = delete;
  Pieces& operator=(const Pieces&) = delete;

  std::span<const std::span<const std::byte>> all() const { return all_; }

 private:
  Bytes head_;
  Preamble preamble_;
  std::uint64_t sum_ = 0;
  std::vector<std::span<const std::byte>> all_;
};

}  // namespace

void write_checkpoint(const Checkpoint& c, const std::string& path) { write_whole_file(path, Pieces(c).all()); }

void write_checkpoint(const Checkpoint& c, std::ostream& to) {
  const Pieces pieces(c);
  for (const auto& piece : pieces.all()) to.write(reinterpret_cast<const char*>(piece.data()), std::streamsize(piece.size()));
  if (!to.flush()) throw Error("the state could not be written to the stream");
}

Checkpoint read_checkpoint(std::istream& from) {
  struct Source {
    std::string bytes;
    size_t at = 0;
    std::uint64_t size() const { return bytes.size(); }
    void seek(std::uint64_t offset) { at = size_t(offset); }
    void read(void* to, std::uint64_t count) {
      if (count > bytes.size() - at) throw Error("it ends too early");
      if (count == 0) return;  // memcpy must not be given the null pointer of an empty part
      std::memcpy(to, bytes.data() + at, size_t(count));
      at += size_t(count);
    }
  } source;
  source.bytes.assign(std::istreambuf_iterator<char>(from), {});
  try {
    return read(source, true);
  } catch (const Error& e) {
    throw Error(fmt::format("cannot use the state: {}", e.what()));
  }
}

Checkpoint read_checkpoint(const std::string& path) { return read(path, true); }
Checkpoint read_checkpoint_header(const std::string& path) { return read(path, false); }

void remove_leftovers(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path file = fs::exists(path, error) ? fs::canonical(path, error) : fs::path(path);
  const std::string stem = "." + file.filename().string() + ".part-";
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(stem)) continue;
    pid_t process = 0;
    const auto [rest, wrong] = std::from_chars(name.data() + stem.size(), name.data() + name.size(), process);
    if (wrong != std::errc() || rest != name.data() + name.size() || process <= 0) continue;
    if (::kill(process, 0) != 0 && errno == ESRCH) {
      std::error_code ignored;
      fs::remove(entry->path(), ignored);
    }
  }
}

}  // namespace etendue
