// Outputs and importers with one fault each, which `etendue conform` must find. All outputs write portable float maps, which
// are simple to make and can be read back.

#include <atomic>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "etendue/film/image_tools.h"
#include "etendue/importer.h"
#include "etendue/output.h"

namespace etendue {
namespace {

/// Portable float map: linear R, G, B, rows from bottom to top.
std::string float_map(const Image& given, bool upside_down = false) {
  const Image image = convert_color_space(given, "srgb");
  std::ostringstream header;
  header << "PF\n" << image.width << " " << image.height << "\n-1.0\n";
  std::string bytes = header.str();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        const auto v = float(image.at(x, upside_down ? y : image.height - 1 - y, c));
        bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
      }
  return bytes;
}

void write_beside(const std::string& path, const std::string& bytes) {
  const std::string beside = path + ".part";
  std::ofstream file(beside, std::ios::binary);
  if (!file.write(bytes.data(), long(bytes.size())).flush()) throw Error("cannot write '" + path + "'");
  file.close();
  if (std::rename(beside.c_str(), path.c_str()) != 0) {
    std::remove(beside.c_str());
    throw Error("cannot write '" + path + "'");
  }
}

class FloatOutput : public Output {
 public:
  std::string extension() const override { return ".pfm"; }
  bool for_display() const override { return false; }
};

class StandingOutput final : public FloatOutput {
 public:
  static void describe(Description<StandingOutput>& d) { d.summary("Writes pictures upside down."); }
  void write_image(const Image& image, const std::string& path) const override { write_beside(path, float_map(image, true)); }
};
const Register<StandingOutput> standing;

class HastyOutput final : public FloatOutput {
 public:
  static void describe(Description<HastyOutput>& d) { d.summary("Writes over the old file before the new one is whole."); }
  void write_image(const Image& image, const std::string& path) const override {
    const std::string bytes = float_map(image);
    std::ofstream file(path, std::ios::binary);
    if (!file.write(bytes.data(), long(bytes.size())).flush()) throw Error("cannot write '" + path + "'");
  }
};
const Register<HastyOutput> hasty;

class LitteringOutput final : public FloatOutput {
 public:
  static void describe(Description<LitteringOutput>& d) { d.summary("Leaves a file beside the picture."); }
  void write_image(const Image& image, const std::string& path) const override {
    write_beside(path, float_map(image));
    std::ofstream(path + ".log") << "written\n";
  }
};
const Register<LitteringOutput> littering;

class SilentOutput final : public FloatOutput {
 public:
  static void describe(Description<SilentOutput>& d) { d.summary("Says nothing when it cannot write."); }
  void write_image(const Image& image, const std::string& path) const override {
    try {
      write_beside(path, float_map(image));
    } catch (const Error&) {
    }
  }
};
const Register<SilentOutput> silent;

class LinesImporter : public Importer {
 public:
  std::vector<std::string> extensions() const override { return {"lines"}; }

 protected:
  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (!(text << file.rdbuf())) throw Error("cannot read '" + path + "'");
    return text.str();
  }
};

class ThrowingImporter final : public LinesImporter {
 public:
  static void describe(Description<ThrowingImporter>& d) { d.summary("Throws what is no Error for files it cannot read."); }
  Ref<Component> import(Importing& importing) const override {
    return std::stoi(read(importing.path())) > 0 ? nullptr : importing.make("Job", importing.at());
  }
};
const Register<ThrowingImporter> throwing;

class NamelessImporter final : public LinesImporter {
 public:
  static void describe(Description<NamelessImporter>& d) { d.summary("Does not say which file it cannot read."); }
  Ref<Component> import(Importing& importing) const override {
    read(importing.path());
    throw Error("line 1 is no line");
  }
};
const Register<NamelessImporter> nameless;

class FickleImporter final : public LinesImporter {
 public:
  static void describe(Description<FickleImporter>& d) { d.summary("Reads the same file otherwise the next time."); }
  Ref<Component> import(Importing& importing) const override {
    read(importing.path());
    static std::atomic<int> times = 0;
    if (++times % 2 == 0) throw Error("'" + importing.path() + "' is no file of lines");
    return importing.make("Job", importing.at());
  }
};
const Register<FickleImporter> fickle;

}  // namespace
}  // namespace etendue
