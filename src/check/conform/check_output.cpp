// Checks of every output: the file holds the image, or it is unchanged and an Error gives the reason.

#include "etendue/output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "conformance.h"
#include "describe/guard.h"
#include "etendue/film/image_tools.h"

namespace etendue::conform {
namespace {

std::string bytes_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

class OutputTrial {
 public:
  explicit OutputTrial(Trial& t) : trial(t), output_(t.part<Output>()), folder_(t.folder()) {}

  void check() {
    const std::string ending = output_.extension();
    if (!trial.expect(ending.size() >= 2 && ending[0] == '.' && ending.find_first_of("/ ", 1) == std::string::npos,
                      "the usual ending is one, with its dot", [&] { return "'" + ending + "'"; }))
      return;
    check_contents();
    check_replacing();
    check_refusals();
  }

 private:
  std::string path(const std::string& stem) const { return folder_ + "/" + stem + output_.extension(); }

  /// Colours within the gamut that differ from pixel to pixel and need more than eight bits; radiance spans four orders of
  /// magnitude.
  Image picture(int width, int height) {
    const bool display = output_.for_display();
    Image image(width, height, display ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"X", "Y", "Z"});
    for (size_t i = 0; i < image.values.size(); i += 3) {
      const double scale = display ? 1 : std::exp(double(lerp(trial.uniform(), -5, 5)));
      double rgb[3];
      for (double& v : rgb) v = scale * double(lerp(trial.uniform(), 0.2f, 1));
      // Approximately the sRGB to XYZ matrix: any colours with positive R, G and B will do.
      constexpr double to_xyz[3][3] = {{0.41, 0.36, 0.18}, {0.21, 0.72, 0.07}, {0.02, 0.12, 0.95}};
      for (size_t c = 0; c < 3; ++c)
        image.values[i + c] = display ? rgb[c] : to_xyz[c][0] * rgb[0] + to_xyz[c][1] * rgb[1] + to_xyz[c][2] * rgb[2];
    }
    image.metadata["color_space"] = display ? "srgb" : "xyz";
    image.metadata["transfer"] = display ? "srgb" : "linear";
    image.metadata["seed"] = "7";
    return image;
  }

  /// Writes the image; returns the message of the Error, "" for none. Other exceptions fail a check.
  std::string refusal(const Image& image, const std::string& to) {
    try {
      output_.write_image(image, to);
    } catch (const Error& e) {
      return *e.what() ? e.what() : "an Error without a reason";
    } catch (...) {
      const std::string thrown = thrown_text();
      trial.expect(false, "what cannot be written is refused by an Error", [&] { return thrown; });
      return thrown;
    }
    return {};
  }

  /// The names of the folder's files, to check that no others appear.
  std::set<std::string> listing() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.insert(entry.path().filename().string());
    return names;
  }
  void expect_alone(const std::set<std::string>& before, const std::string& added) {
    std::set<std::string> wanted = before;
    if (!added.empty()) wanted.insert(added);
    trial.expect(listing() == wanted, "nothing is left beside the file",
                 [&] { return fmt::format("{} files, not {}", listing().size(), wanted.size()); });
  }

  void check_contents() {
    for (const auto& [width, height] : {std::pair{1, 1}, {13, 6}, {5, 40}}) {
      const Image image = picture(width, height);
      const std::string to = path(fmt::format("picture{}", width));
      const std::set<std::string> before = listing();
      const std::string refused = refusal(image, to);
      if (!trial.expect(refused.empty(), "a picture is written", [&] { return refused; })) return;
      expect_alone(before, std::filesystem::path(to).filename().string());
      const std::string bytes = bytes_in(to);
      refusal(image, to);
      trial.expect(bytes_in(to) == bytes, "the same picture gives the same file");
      compare(image, to);
    }
  }

  /// Compares the file with the image, if the library can read the format.
  void compare(const Image& image, const std::string& file) {
    std::optional<Image> read;
    try {
      read = read_image(file);
    } catch (const Error& e) {
      trial.not_tried("what is read back is what was written", e.what());
      return;
    }
    if (!trial.expect(read->width == image.width && read->height == image.height, "what is read back is of the same size", [&] {
          return fmt::format("{} x {}, not {} x {}", read->width, read->height, image.width, image.height);
        }))
      return;
    for (const auto& [key, text] : read->metadata)
      if (const auto given = image.metadata.find(key);
          given != image.metadata.end() && key != "color_space" && key != "transfer")
        trial.expect(text == given->second, "texts that are read back are those that were written",
                     [&, k = key, t = text] { return fmt::format("{}: '{}', not '{}'", k, t, image.metadata.at(k)); });
    const Image is = convert_color_space(*read, "xyz"), wanted = convert_color_space(image, "xyz");
    const size_t stride = is.channels.size();
    for (size_t p = 0; p < size_t(image.width) * size_t(image.height); ++p) {
      double largest = 0;
      for (size_t c = 0; c < 3; ++c) largest = std::max(largest, wanted.values[3 * p + c]);
      // For display: a step of 8-bit quantization with its noise, decoded. For radiance: a step of a shared exponent with 8-bit
      // mantissas.
      const double tolerance = output_.for_display() ? 0.012 : 0.02 * largest;
      for (size_t c = 0; c < 3; ++c)
        trial.expect(std::abs(is.values[p * stride + c] - wanted.values[3 * p + c]) <= tolerance,
                     "what is read back is what was written", [&] {
                       return fmt::format("{} of pixel {}, {}: {}, not {}", "XYZ"[c], p % size_t(image.width),
                                          p / size_t(image.width), is.values[p * stride + c], wanted.values[3 * p + c]);
                     });
    }
  }

  /// A process that has the old file open must still read it unchanged: the new file is written to a temporary file and
  /// renamed.
  void check_replacing() {
    const std::string to = path("replaced"), old(100000, 'o');
    std::ofstream(to, std::ios::binary) << old;
    const int reader = open(to.c_str(), O_RDONLY | O_CLOEXEC);
    refusal(picture(8, 8), to);
    std::string seen(old.size() + 1, ' ');
    const ssize_t count = reader < 0 ? -1 : pread(reader, seen.data(), seen.size(), 0);
    if (reader >= 0) close(reader);
    seen.resize(size_t(std::max<ssize_t>(count, 0)));
    trial.expect(seen == old, "the file is written beside and put in place when it is whole",
                 [] { return std::string("who had the old file open sees it change"); });
  }

  void check_refusals() {
    const std::string to = path("kept"), old = "as it was";
    std::ofstream(to, std::ios::binary) << old;
    Image strange(4, 3, {"layer.a"});
    const std::set<std::string> before = listing();
    std::string why = refusal(strange, to);
    trial.expect(!why.empty() && bytes_in(to) == old, "a picture without colours is refused, and the file is as it was",
                 [&] { return why.empty() ? "it was taken" : "the file was changed"; });
    if (output_.for_display()) {
      Image radiance = picture(4, 3);
      radiance.channels = {"X", "Y", "Z"};
      why = refusal(radiance, to);
      trial.expect(!why.empty() && bytes_in(to) == old,
                   "a picture that was not tone mapped is refused, and the file is as it was",
                   [&] { return why.empty() ? "it was taken" : "the file was changed"; });
    }
    expect_alone(before, "");

    const std::string nowhere = folder_ + "/no such folder/picture" + output_.extension();
    why = refusal(picture(4, 3), nowhere);
    trial.expect(why.find(nowhere) != std::string::npos, "an Error names the path that cannot be written",
                 [&] { return "'" + why + "'"; });
    const std::string taken = path("a folder");
    std::filesystem::create_directory(taken);
    why = refusal(picture(4, 3), taken);
    trial.expect(why.find(taken) != std::string::npos && std::filesystem::is_directory(taken), "a folder is not written over",
                 [&] { return "'" + why + "'"; });

    // Values that are no valid radiance may be kept or clamped by the format; the file must still be an image.
    Image odd = picture(4, 3);
    const double values[] = {std::nan(""), -1, 1e300, std::numeric_limits<double>::infinity(), 0, -0.0};
    for (size_t i = 0; i < std::size(values); ++i) odd.values[i] = values[i];
    why = refusal(odd, path("odd"));
    trial.expect(why.empty() || !std::filesystem::exists(path("odd")), "a refused picture leaves no file", [&] { return why; });
  }

  Trial& trial;
  const Output& output_;
  const std::string folder_;
};

void check_output(Trial& trial) { OutputTrial(trial).check(); }

const RegisterCheck<Output> registered(check_output);

}  // namespace
}  // namespace etendue::conform
