#include "scene_transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

namespace etendue {
namespace {

namespace fs = std::filesystem;

/// What a letter of the kind `scene` says, after the number of the render.
enum class SceneWord : std::uint8_t {
  files,  ///< of the leader: the working folder and the files
  lacks,  ///< of a follower: it needs a scene folder, and lacks so many bytes; 0: it needs nothing
  take,   ///< of the leader: take what you lack, first from this folder on your machine, if it is not empty
  piece,  ///< of a follower: a piece of this file, from this byte; of the leader: its bytes
  ready,  ///< of a follower: all is there, and others on this machine may take it from this folder
};

constexpr std::uint64_t piece_size = std::uint64_t(4) << 20;
constexpr int pieces_under_way = 2;

/// Reads a piece of a file. Throws Error.
std::vector<std::byte> piece_of(const SentFile& file, std::uint64_t begin) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> from(std::fopen(file.path.c_str(), "rb"), std::fclose);
  const auto fail = [&](const std::string& reason) { throw Error(fmt::format("'{}' cannot be sent: {}", file.path, reason)); };
  if (!from) fail(std::strerror(errno));
  std::vector<std::byte> bytes(size_t(std::min(piece_size, file.size - std::min(begin, file.size))));
  if (::fseeko(from.get(), off_t(begin), SEEK_SET) != 0) fail(std::strerror(errno));
  if (std::fread(bytes.data(), 1, bytes.size(), from.get()) != bytes.size()) fail("it has become shorter");
  return bytes;
}

std::vector<SentFile> files_at(const std::vector<std::string>& paths) {
  std::vector<SentFile> files;
  for (const std::string& path : paths) {
    const FileContent content = content_on_disk(path);
    if (content.size != std::uint64_t(-1)) files.push_back({path, content.size, content.hash});
  }
  return files;
}

/// The leader's part.
class Sender {
 public:
  Sender(ProcessTeam& team, std::vector<SentFile> files) : team_(team), files_(std::move(files)) {}

  SceneSent run() {
    Writing all = team_.scene_letter(SceneWord::files);
    all.add(fs::current_path().string()).add(std::uint64_t(files_.size()));
    for (const SentFile& file : files_) all.add(file.path).add(file.size).add(file.hash);
    const Parcel parcel = all.parcel();
    for (int rank = 1; rank < team_.size(); ++rank) team_.send_scene_letter(rank, parcel);
    sent_.files = files_.size();
    while (int(ready_.size()) < team_.size() - 1) {
      std::optional<Reading> letter = team_.next_scene_letter();
      if (letter) answer(*letter);
    }
    sent_.receivers = receivers_.size();
    return sent_;
  }

 private:
  void answer(Reading& letter) {
    const int from = letter.from;
    switch (letter.take<SceneWord>()) {
      case SceneWord::lacks:
        if (letter.take<std::uint64_t>() == 0)
          ready_.insert(from);
        else
          receive_in_turn(from);
        break;
      case SceneWord::piece: {
        const auto index = letter.take<std::uint64_t>(), begin = letter.take<std::uint64_t>();
        const std::vector<std::byte> bytes = piece_of(files_.at(size_t(index)), begin);
        sent_.bytes += bytes.size();
        receivers_.insert(from);
        team_.send_scene_letter(from, team_.scene_letter(SceneWord::piece).add(index).add(begin).add(bytes).parcel());
        break;
      }
      case SceneWord::ready: {
        ready_.insert(from);
        Machine& machine = machines_[team_.host_of(from)];
        machine.folder = letter.take_text();
        for (const int next : std::exchange(machine.waiting, {})) let_take(next, machine.folder);
        break;
      }
      default: throw Error("a letter for a follower");
    }
  }

  /// The first on a machine begins, the others wait for it.
  void receive_in_turn(int rank) {
    const auto [machine, first] = machines_.try_emplace(team_.host_of(rank));
    if (first || !machine->second.folder.empty())
      let_take(rank, machine->second.folder);
    else
      machine->second.waiting.push_back(rank);
  }
  void let_take(int rank, const std::string& folder) {
    team_.send_scene_letter(rank, team_.scene_letter(SceneWord::take).add(folder).parcel());
  }

  /// A machine with processes that lack files.
  struct Machine {
    std::string folder;        ///< of the first one that has all; empty: it is on its way
    std::vector<int> waiting;  ///< the others
  };
  ProcessTeam& team_;
  const std::vector<SentFile> files_;
  std::map<std::string, Machine> machines_;
  std::set<int> ready_, receivers_;
  SceneSent sent_;
};

/// A follower's part.
class Receiver {
 public:
  Receiver(ProcessTeam& team, SceneFolder& folder, const std::vector<SentFile>& files)
      : team_(team), folder_(folder), files_(files) {
    std::set<std::pair<std::uint64_t, std::uint64_t>> seen;
    for (size_t i = 0; i < files.size(); ++i) {
      if (folder.has(files[i]) || !seen.insert({files[i].hash, files[i].size}).second) continue;
      lacking_.push_back(i);
      bytes_ += files[i].size;
    }
  }

  /// False: the leader's render has ended.
  bool run() {
    folder_.require_room(bytes_);
    team_.send_scene_letter(0, team_.scene_letter(SceneWord::lacks).add(std::max<std::uint64_t>(bytes_, 1)).parcel());
    std::optional<Reading> letter = team_.next_scene_letter();
    if (!letter) return false;
    if (letter->take<SceneWord>() != SceneWord::take) throw Error("the leader sends what was not asked for");
    if (const std::string other = letter->take_text(); !other.empty())
      std::erase_if(lacking_, [&](size_t file) { return folder_.take_from(other, files_[file]); });
    return std::ranges::all_of(lacking_, [&](size_t file) { return receive(file); });
  }

 private:
  bool receive(size_t index) {
    const SentFile& file = files_[index];
    SceneFolder::Arriving arriving(folder_, file);
    std::uint64_t asked = 0, have = 0;
    while (have < file.size) {
      for (; asked < file.size && asked < have + pieces_under_way * piece_size; asked += piece_size)
        team_.send_scene_letter(0, team_.scene_letter(SceneWord::piece).add(std::uint64_t(index)).add(asked).parcel());
      std::optional<Reading> letter = team_.next_scene_letter();
      if (!letter) return false;
      if (letter->take<SceneWord>() != SceneWord::piece || letter->take<std::uint64_t>() != index ||
          letter->take<std::uint64_t>() != have)
        throw Error("the leader sends what was not asked for");
      const auto bytes = letter->take<std::vector<std::byte>>();
      if (bytes.empty()) throw Error(fmt::format("'{}' has become shorter while it was sent", file.path));
      arriving.add(bytes);
      have += bytes.size();
    }
    arriving.finish();
    return true;
  }

  ProcessTeam& team_;
  SceneFolder& folder_;
  const std::vector<SentFile>& files_;
  std::vector<size_t> lacking_;  ///< each content once
  std::uint64_t bytes_ = 0;
};

/// Changes to the leader's working folder, if it is here too.
bool enter(const std::string& folder) {
  std::error_code error;
  fs::current_path(folder, error);
  return !error;
}

}  // namespace

SceneSent send_scene(ProcessTeam& team, const std::vector<std::string>& paths) { return Sender(team, files_at(paths)).run(); }

bool receive_scene(ProcessTeam& team, std::unique_ptr<SceneFolder>& folder) {
  std::optional<Reading> letter = team.next_scene_letter();
  if (!letter) return false;
  if (letter->take<SceneWord>() != SceneWord::files) throw Error("the leader sends what was not asked for");
  const std::string working_folder = letter->take_text();
  std::vector<SentFile> files(size_t(letter->take<std::uint64_t>()));
  for (SentFile& file : files) {
    file.path = letter->take_text();
    file.size = letter->take<std::uint64_t>();
    file.hash = letter->take<std::uint64_t>();
  }
  if (!folder && sees_all(files) && enter(working_folder)) {
    team.send_scene_letter(0, team.scene_letter(SceneWord::lacks).add(std::uint64_t(0)).parcel());
    return true;
  }
  if (!folder) folder = std::make_unique<SceneFolder>();
  if (!Receiver(team, *folder, files).run()) return false;
  folder->show(files, working_folder);
  team.send_scene_letter(0, team.scene_letter(SceneWord::ready).add(folder->path()).parcel());
  return true;
}

}  // namespace etendue
