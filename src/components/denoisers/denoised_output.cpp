#include "etendue/denoised_output.h"

#include <filesystem>

namespace etendue {

void DenoisedOutput::describe(Description<DenoisedOutput>& d) {
  d.summary(
       "Writes the picture by another output, and beside it, as NAME.denoised.ENDING, what a denoiser makes of it before the "
       "tone map: less noise, and a bias, which its texts tell.")
      .member<&DenoisedOutput::output>(
          "output", "", "the format; of its members 'file' and 'tone_map' are not used, but those here", Effect::retone)
      .member<&DenoisedOutput::denoiser>("denoiser", "", "what takes the noise away", Effect::retone);
}

static const Register<DenoisedOutput> registered;

DenoisedOutput::DenoisedOutput()
    : output(ref_cast<Output>(Registry::instance().create("PngOutput"))),
      denoiser(ref_cast<Denoiser>(Registry::instance().create("OpenImageDenoiser"))) {}

void DenoisedOutput::prepare() {
  if (!output) fail("output", "an output is needed, such as PngOutput {}");
  if (!denoiser) fail("denoiser", "a denoiser is needed, such as OpenImageDenoiser {}");
  if (dynamic_cast<const DenoisedOutput*>(output.get())) fail("output", "what is denoised already is not denoised again");
  const auto unused = [&](const char* member) {
    warn(std::string("DenoisedOutput: '") + member + "' of its output is not used; write it in DenoisedOutput",
         output->location_of(member));
  };
  if (!output->file.empty()) unused("file");
  if (output->tone_map) unused("tone_map");
}

std::string DenoisedOutput::denoised_path(const std::string& path) {
  const std::filesystem::path whole = path;
  return (whole.parent_path() / (whole.stem().string() + ".denoised" + whole.extension().string())).string();
}

}  // namespace etendue
