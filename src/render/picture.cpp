// The output of a render: metadata of pictures, and their files.

#include "denoising.h"
#include "etendue/render/render.h"
#include "images/surface_mattes.h"

namespace etendue {

std::map<std::string, std::string> picture_metadata(const Job& job, std::uint32_t samples) {
  std::map<std::string, std::string> texts = job.metadata;
  texts["seed"] = std::to_string(job.seed);
  texts["samples"] = std::to_string(samples);
  if (job.renderer) {
    texts["renderer"] = job.renderer->class_info().name;
    if (const std::string bias = job.renderer->bias(); !bias.empty()) texts["bias"] = bias;
  }
  texts["version"] = ETENDUE_VERSION;
  return texts;
}

Image RenderSnapshot::picture() const {
  Image picture = film.develop();
  if (surfaces) {
    surfaces->add_channels(picture);
    add_mattes(picture, *surfaces);
  }
  for (const auto& [key, text] : metadata) picture.metadata[key] = text;
  return picture;
}

const ToneMap* tone_map_of(const Job& job, const Output& output) {
  return (output.tone_map || !output.for_display() ? output.tone_map : job.tone_map).get();
}

std::string write_output(const Job& job, const Output& output, const Image& picture, const std::string& default_stem) {
  const ToneMap* tone = tone_map_of(job, output);
  const std::string path = output.path(default_stem);
  output.write_image(tone ? tone->apply(picture) : picture, path);
  return path;
}

}  // namespace etendue
