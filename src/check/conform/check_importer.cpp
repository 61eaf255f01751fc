// Checks of every importer, whatever its format: a file that it cannot read throws an Error that names the file, and a file
// that it can read gives the same result each time.

#include "etendue/importer.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "conformance.h"
#include "describe/guard.h"
#include "etendue/language/language.h"
#include "etendue/render/job.h"

namespace etendue::conform {
namespace {

class ImporterTrial {
 public:
  explicit ImporterTrial(Trial& t) : trial(t), importer_(t.part<Importer>()), folder_(t.folder()) {}

  void check() {
    const std::vector<std::string> endings = importer_.extensions();
    trial.expect(!endings.empty(), "it says which endings it reads");
    for (const std::string& ending : endings) {
      const bool lower = std::ranges::none_of(ending, [](unsigned char c) { return c == '.' || c == '/' || std::isupper(c); });
      trial.expect(!ending.empty() && lower, "endings are of small letters, without a dot", [&] { return "'" + ending + "'"; });
      check_ending(ending);
    }
  }

 private:
  void check_ending(const std::string& ending) {
    trial.expect(!told(import(folder_ + "/missing." + ending)).empty(), "a missing file is an Error that names it");
    const std::string folder = folder_ + "/folder." + ending;
    std::filesystem::create_directory(folder);
    trial.expect(!told(import(folder)).empty(), "a folder is an Error that names it");
    int number = 0;
    for (const std::string& contents : hostile()) {
      const std::string path = fmt::format("{}/hostile{}.{}", folder_, ++number, ending);
      std::ofstream(path, std::ios::binary) << contents;
      const std::string once = text(import(path)), again = text(import(path));
      trial.expect(once == again, "the same file gives the same components, or the same error",
                   [&] { return fmt::format("{}\n--- and then\n{}", once, again); });
      std::ifstream file(path, std::ios::binary);
      std::ostringstream now;
      now << file.rdbuf();
      trial.expect(now.str() == contents, "the file stays as it is");
    }
  }

  /// Files of no format, and beginnings of files of some formats.
  std::vector<std::string> hostile() {
    std::vector<std::string> all = {"",
                                    "\n",
                                    std::string(1, '\0'),
                                    std::string(4096, '\xff'),
                                    "{\"asset\": {\"version\": \"2.0\"}",
                                    "<?xml version=\"1.0\"?><scene version=\"3.0.0\">",
                                    "WorldBegin\nShape \"sphere\" \"float radius\" [",
                                    "v 1 2\nf 1 2 99999999999999999999\n",
                                    std::string(20000, '[') + "1",
                                    "%PDF-1.4 \xe2\xe3\xcf\xd3"};
    for (int i = trial.samples(12); i > 0; --i) {
      std::string noise(1 + trial.random() % 600, ' ');
      for (char& c : noise) c = char(i % 2 == 0 ? trial.random() : ' ' + trial.random() % 95);
      all.push_back(noise);
    }
    return all;
  }

  struct Imported {
    Ref<Component> component;
    std::vector<Error> notes;
    std::string path, error;
  };

  Imported import(const std::string& path) {
    Imported r{{}, {}, path, {}};
    try {
      Importing importing(path, {});
      r.component = importer_.import(importing);
      trial.expect(ref_cast<Job>(r.component) || ref_cast<Scene>(r.component), "what is imported is a Job or a Scene");
      r.notes = importing.notes();
    } catch (const Errors& e) {
      for (const Error& each : e.errors)
        r.error += std::string(r.error.empty() ? "" : "\n") + each.what() +
                   (each.location.known() ? " at " + std::string(each.location.file) : "");
    } catch (const Error& e) {
      r.error = e.what() + (e.location.known() ? " at " + std::string(e.location.file) : "");
    } catch (...) {
      r.error = thrown_text();
      trial.expect(false, "a file that cannot be read is an Error, and nothing else is thrown",
                   [&] { return fmt::format("'{}': {}", path, r.error); });
    }
    if (!r.error.empty())
      trial.expect(r.error.find(path) != std::string::npos, "an Error names the file", [&] { return r.error; });
    return r;
  }

  static std::string told(const Imported& i) { return i.error; }
  static std::string text(const Imported& i) {
    std::string all = i.error;
    if (i.component) all += write_description(*i.component);
    for (const Error& note : i.notes) all += note.what() + std::string("\n");
    return all;
  }

  Trial& trial;
  const Importer& importer_;
  const std::string folder_;
};

void check_importer(Trial& trial) { ImporterTrial(trial).check(); }

const RegisterCheck<Importer> registered(check_importer);

}  // namespace
}  // namespace etendue::conform
