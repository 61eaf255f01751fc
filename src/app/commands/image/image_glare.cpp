// etendue image glare: UGR and DGP of a picture of all directions.

#include "image_glare.h"

#include <fmt/format.h>

#include "app/commands.h"
#include "check/measure/glare.h"
#include "etendue/film/image_tools.h"
#include "files/input_files.h"

namespace etendue {
namespace {

struct GlareCommandOptions : measure::GlareOptions {
  std::string file, mapping_name;
  bool json = false;
};

const std::vector<std::string> mappings = {"equirectangular", "equal_area", "angular", "hemispherical"};

int show(GlareCommandOptions options) {
  note_input(options.file);
  const Image image = read_image(options.file);
  if (options.mapping_name.empty()) {
    // Only an equirectangular picture is known by its shape.
    if (image.width != 2 * image.height)
      throw Error(fmt::format("must be given: a picture of {} x {} pixels may be in any mapping", image.width, image.height),
                  {intern("--mapping"), 0, 0});
    options.mapping_name = mappings.front();
  }
  options.mapping = measure::FisheyeMapping(std::ranges::find(mappings, options.mapping_name) - mappings.begin());
  const measure::Glare glare = measure::glare_of(image, options);
  fmt::print("{}", options.json ? measure::glare_json(glare) : measure::glare_text(glare));
  return exit_status::done;
}

}  // namespace

void add_image_glare(Command& image) {
  Command command = image.add_command("glare", "Print the glare (UGR, DGP) that an eye at the camera's place would have");
  auto options = std::make_shared<GlareCommandOptions>();
  command.argument("FILE", options->file, "A picture of radiance: of a SphericalCamera, or from a fisheye lens").required();
  command
      .option(
          "--mapping NAME", options->mapping_name,
          "How directions lie in the picture: equirectangular or equal_area as of a SphericalCamera, angular (equidistant) or "
          "hemispherical (orthographic) as of a fisheye. Without it, a picture twice as wide as high is equirectangular")
      .one_of(mappings);
  command.option("--angle DEG", options->angle, "Across an angular picture").show_default().range(1.0, 360.0);
  command
      .option("--threshold CD/M2", options->threshold,
              "Luminance from which pixels belong to a source; without it, --factor decides")
      .range(1e-9, 1e12);
  command.option("--factor F", options->factor, "The threshold as a multiple of the mean luminance in front of the eye")
      .show_default()
      .excludes({"--threshold"})
      .range(0.0, 1e6);
  command
      .option("--peak CD/M2", options->peak,
              "Luminance from which pixels are a source of their own within another, as the sun in a window; 0: none are")
      .show_default()
      .range(0.0, 1e12);
  command.option("--yaw DEG", options->yaw, "Look to the right of the middle of a picture of the whole sphere")
      .show_default()
      .range(-360.0, 360.0);
  command.option("--pitch DEG", options->pitch, "and upwards").show_default().range(-90.0, 90.0);
  command
      .option("--luminance-of-one CD/M2", options->luminance_of,
              "Luminance of white of the value 1, where it is not that of this program's pictures: 179 for Radiance's")
      .range(1e-9, 1e12);
  command.flag("--json", options->json, "Print JSON");
  command.footer(
      "\nExamples\n"
      "  etendue image glare desk.exr\n"
      "  etendue image glare desk.exr --yaw 45 --threshold 2000 --json\n"
      "  etendue image glare photo.hdr --mapping angular --angle 180 --luminance-of-one 179\n"
      "\ndocs/lighting.md tells more.");
  command.runs([options] { return show(*options); });
}

}  // namespace etendue
