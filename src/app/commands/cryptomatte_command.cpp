// etendue cryptomatte FILE: mattes of all objects, materials and assets of a picture.

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/common_options.h"
#include "app/interruption.h"
#include "app/render_options.h"
#include "app/text.h"
#include "components/outputs/encoded_image.h"
#include "etendue/film/image_tools.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "film/picture_format.h"
#include "render/checkpoint.h"
#include "render/mattes/mattes.h"

namespace etendue {
namespace {

/// Samples, seed, size and crop are those of a render.
struct MatteOptions : RenderOptions {
  std::string output;
  int ranks = 0;
};

/// What sees the first surfaces with the samples of the file's renderer. Only how these are made matters, so that a renderer
/// with photons or Markov chains need not prepare any.
void see_only(Job& job) {
  const auto tracer = ref_cast<Renderer>(Registry::instance().create("PathTracer"));
  tracer->sampler = job.renderer->sampler;
  tracer->samples = job.renderer->samples;
  job.renderer = tracer;
}

int render_file(const MatteOptions& options) {
  if (!options.output.ends_with(".exr"))
    throw Error("'" + options.output + "' must end in .exr: mattes are channels of OpenEXR", {intern("--output"), 0, 0});
  const Ref<Job> job = options.load_overridden();
  if (job->renderer) see_only(*job);
  note_inputs_of(*job);
  OutputFiles files;
  files.add(options.output, {intern("--output"), 0, 0});
  files.raise();
  require_image_library();

  Render render(job, {.threads = options.threads});
  const Interruption interruption(render);
  const bool show = isatty(STDERR_FILENO) && !options.quiet;
  const std::vector<Cryptomatte> mattes = render_mattes(render, options.threads, [&](double done) {
    if (show) fmt::print(stderr, "\r\x1b[K{:.0f} %{}", 100 * done, done < 1 ? "" : "\r\x1b[K");
    return !Interruption::asked();
  });
  if (mattes.empty()) return exit_status::interrupted;

  Image image = cryptomatte_image(mattes, options.ranks);
  image.metadata.merge(picture_metadata(*job, std::uint32_t(job->renderer->samples)));
  std::vector<ImageHeader::Channel> channels;
  for (const std::string& name : image.channels) channels.push_back({name, NumberType::single});
  ImageHeader header(image.width, image.height, std::move(channels));
  header.texts = image.metadata;
  const PictureFormat& format = *job->image->format();
  header.x = format.area.x0;
  header.y = format.area.y0;
  header.whole = {0, 0, format.width, format.height};
  const std::vector<float> values(image.values.begin(), image.values.end());
  write_encoded(options.output, ".exr", header, PixelValues(std::span<const float>(values)));
  if (options.quiet) return exit_status::done;
  for (const Cryptomatte& kind : mattes) {
    size_t most = 0;
    for (const auto& pixel : kind.pixels) most = std::max(most, pixel.size());
    fmt::print("{}: {} names, at most {} in a pixel\n", kind.name, kind.manifest.size(), most);
  }
  return exit_status::done;
}

}  // namespace

void add_cryptomatte_command(Command& program) {
  Command command = program.add_command("cryptomatte", "Write mattes of all objects, materials and assets of a picture");
  auto options = std::make_shared<MatteOptions>();
  options->SceneOptions::add_to(command);
  command.option("-o,--output FILE", options->output, "The EXR file to write").required();
  command.option("--samples N", options->samples, "Samples per pixel");
  command.option("--size WxH", options->size, "Size of the picture in pixels");
  command.option("--crop X0,Y0,X1,Y1", options->crop, "Mattes of these pixels only; X1 and Y1 are excluded");
  command.option("--ranks N", options->ranks, "Keep only the N largest coverages of a pixel; 0: all")
      .show_default()
      .range(0, 200);
  command.option("--seed N", options->seed, "Seed of the random numbers");
  add_threads_option(command, options->threads);
  command.flag("--quiet", options->quiet, "Print nothing but errors");
  command.footer(
      "\nExamples\n"
      "  etendue cryptomatte box.etd -o mattes.exr --samples 64\n"
      "  etendue image cryptomatte mattes.exr --select lamp -o lamp.png\n"
      "\nThe samples are those of a render of the file, so that the mattes fit its picture. docs/cryptomatte.md tells more.");
  command.runs([options] { return render_file(*options); });
}

}  // namespace etendue
