// Checks of every exporter: its file name extensions, that it writes the same text for the same job, and that it leaves the job
// unchanged.

#include <algorithm>
#include <cctype>

#include "conformance.h"
#include "describe/guard.h"
#include "etendue/exporter.h"
#include "etendue/language/language.h"
#include "etendue/render/job.h"

namespace etendue::conform {
namespace {

/// A job of simple components.
Ref<Job> plain_job() {
  return load_job_text(
      "Job {\n camera: PerspectiveCamera { from: [0, 1, 4] m, to: [0, 0, 0] m }\n image: ImageBuffer { width: 8, height: 6 }\n"
      " scene: BruteForceScene { objects: [\n  Sphere { shader: Lambertian { color: rgb(0.2, 0.4, 0.6) } }\n"
      "  Rectangle { transform: translate(0, 0, -2), emission: DiffuseEmission { radiance: blackbody(3000 K) } }\n ] }\n}\n",
      "plain.etd");
}

void check_exporter(Trial& trial) {
  const Exporter& exporter = trial.part<Exporter>();
  const std::vector<std::string> endings = exporter.extensions();
  trial.expect(!endings.empty(), "it says which endings it writes");
  for (const std::string& ending : endings) {
    const bool lower = std::ranges::none_of(ending, [](unsigned char c) { return c == '.' || c == '/' || std::isupper(c); });
    trial.expect(!ending.empty() && lower, "endings are of small letters, without a dot", [&] { return "'" + ending + "'"; });
    std::string written[2], told[2];
    for (int i = 0; i < 2; ++i) try {
        const Ref<Job> job = plain_job();
        const std::string before = write_description(*job);
        Exporting exporting(trial.folder() + "/plain." + ending);
        written[i] = exporter.write(*job, exporting);
        for (const Error& note : exporting.notes()) told[i] += note.what() + std::string("\n");
        trial.expect(write_description(*job) == before, "the job stays as it is");
      } catch (...) {
        trial.expect(false, "a job of the plainest parts can be written", [] { return thrown_text(); });
      }
    trial.expect(!written[0].empty(), "something is written");
    trial.expect(written[0] == written[1] && told[0] == told[1], "the same job is written the same");
  }
}

const RegisterCheck<Exporter> registered(check_exporter);

}  // namespace
}  // namespace etendue::conform
