// The part of the page with images and maps.

#include <fmt/format.h>

#include "check/verify/report_pictures.h"
#include "describe/html_text.h"
#include "maps.h"
#include "plot.h"
#include "report.h"

namespace etendue::comparing {

const std::string_view picture_style = R"(
.row { display: flex; flex-wrap: wrap; gap: .8rem; margin: .8rem 0; }
figure { margin: 0; padding: .5rem; background: var(--panel); border-radius: .3rem; }
figure img { display: block; width: 15rem; image-rendering: pixelated; }
.framed { position: relative; }
.framed span { position: absolute; outline: 1.5px solid #fff; box-shadow: 0 0 0 2.5px #000; }
.small { display: flex; gap: .4rem; margin-top: .4rem; }
.small img { width: 7.3rem; }
figcaption { font-size: .85rem; margin-top: .3rem; max-width: 15rem; }
.scale { width: 18rem; font-size: .8rem; margin: .4rem 0 1rem; }
.scale .bar { height: .8rem; border: 1px solid var(--line); }
.scale .ends { display: flex; justify-content: space-between; }
)";

namespace {

std::string with_insets(const Shown& shown, const std::vector<PixelArea>& insets, const std::string& caption) {
  std::string text = fmt::format("<figure><div class=\"framed\"><img alt=\"{}\" src=\"{}\">", caption, shown.uri());
  const auto percent = [](int part, int of) { return 100.0 * part / of; };
  for (const PixelArea& a : insets)
    text +=
        fmt::format("<span style=\"left:{:.2f}%;top:{:.2f}%;width:{:.2f}%;height:{:.2f}%\"></span>", percent(a.x0, shown.width),
                    percent(a.y0, shown.height), percent(a.width(), shown.width), percent(a.height(), shown.height));
  text += "</div><div class=\"small\">";
  for (const PixelArea& a : insets) text += fmt::format("<img alt=\"enlarged\" src=\"{}\">", shown.part(a).uri());
  return text + fmt::format("</div><figcaption>{}</figcaption></figure>\n", caption);
}

/// A colour scale from left to right, with texts for its ends and middle.
template <class Color>
std::string scale_bar(const Color& color, const std::string& low, const std::string& middle, const std::string& high) {
  std::string stops;
  for (int i = 0; i <= 10; ++i) {
    const auto c = color(i / 10.0);
    stops += fmt::format(",rgb({} {} {})", c[0], c[1], c[2]);
  }
  return fmt::format(
      "<div class=\"scale\"><div class=\"bar\" style=\"background:linear-gradient(90deg{})\"></div>"
      "<div class=\"ends\"><span>{}</span><span>{}</span><span>{}</span></div></div>\n",
      stops, low, middle, high);
}

std::string row(const SceneResult& scene, const std::vector<Shown>& maps, std::string_view what) {
  std::string text = "<div class=\"row\">\n";
  for (size_t v = 0; v < maps.size(); ++v)
    text += fmt::format("<figure><img alt=\"{} of {}\" src=\"{}\"><figcaption>{}{}</figcaption></figure>\n", what,
                        escaped(scene.variants[v].name), maps[v].uri(), legend_mark(v), escaped(scene.variants[v].name));
  return text + "</div>\n";
}

std::string bias_maps(const SceneResult& scene, const SceneImages& images) {
  std::string text;
  for (size_t v = 0; v < scene.variants.size(); ++v) {
    const Bias& bias = scene.variants[v].bias;
    if (!bias.known) continue;
    text += fmt::format("<figure><img alt=\"bias by tiles of {0}\" src=\"{1}\"><figcaption>{2}{0}</figcaption></figure>\n",
                        escaped(scene.variants[v].name), verify::difference_map(images.layout, bias.test, 0), legend_mark(v));
  }
  if (text.empty()) return {};
  return "<h3>Bias by tiles</h3>\n<p>How many standard errors the mean of all runs is above (red) or below (blue) the "
         "reference; "
         "black frames: significant. Where all is well the colours are pale and without pattern.</p>\n<div class=\"row\">\n" +
         text + "</div>\n" +
         scale_bar([](double t) { return verify::difference_color(verify::z_of_full_color * (2 * t - 1)); },
                   fmt::format("z −{}", verify::z_of_full_color), "0", fmt::format("+{}", verify::z_of_full_color));
}

}  // namespace

std::string scene_pictures(const SceneResult& scene, const SceneImages& images, const ToneMap& tone_map,
                           const std::vector<PixelArea>& given) {
  const std::vector<PixelArea> insets = given.empty() ? most_different(images, scene, 2) : given;
  std::vector<std::vector<double>> pictures{images.reference};
  for (const SceneImages::One& one : images.variants) pictures.emplace_back(one.picture.begin(), one.picture.end());
  const std::vector<Shown> shown = show_alike(tone_map, pictures, scene.width, scene.height);

  std::string text = "<h3>Pictures</h3>\n<p>The first run of each variant" +
                     std::string(given.empty() ? ", enlarged where the variants' errors differ most" : "") +
                     ".</p>\n<div class=\"row\">\n";
  text += with_insets(shown.front(), insets, "reference");
  for (size_t v = 0; v < scene.variants.size(); ++v) text += with_insets(shown[v + 1], insets, escaped(scene.variants[v].name));
  text += "</div>\n";

  const DifferenceMaps differences = difference_maps(images, scene);
  text += "<h3>Differences from the reference</h3>\n<p>The first run, (Y − R) / √(R² + ε).</p>\n" +
          row(scene, differences.maps, "difference") +
          scale_bar([](double t) { return verify::difference_color(verify::z_of_full_color * (2 * t - 1)); },
                    fmt::format("−{:.2g}: darker", differences.full), "0", fmt::format("+{:.2g}: brighter", differences.full));
  text += bias_maps(scene, images);
  const VarianceMaps variances = variance_maps(images, scene);
  text +=
      "<h3>Variance per second</h3>\n<p>The variance of Y that one second of the processor leaves: variance of the runs times "
      "their "
      "time, mean of 3 × 3 pixels.</p>\n" +
      row(scene, variances.maps, "variance per second") +
      scale_bar([](double t) { return scale_color(t); }, fmt::format("{:.2g}", variances.low), "",
                fmt::format("{:.2g}", variances.high));
  return text;
}

}  // namespace etendue::comparing
