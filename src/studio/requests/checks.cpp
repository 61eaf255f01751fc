// Requests that check the description, the classes and the renderer: warnings, and tasks that take longer.

#include <fmt/format.h>

#include "check/replay/strategies.h"
#include "etendue/language/language.h"
#include "images/base64.h"
#include "requests.h"
#include "studio/pixels/half.h"
#include "studio/pixels/linear_srgb.h"

namespace etendue::studio {

namespace {

/// The warnings that `etendue render` would print.
Json warnings(const Call& call) {
  const auto render = call.studio.valid_render();
  const StudioSettings& settings = call.studio.settings();
  Json list = Json::array(), advice = Json::array();
  if (settings.warnings)
    for (const auto& [kind, error] : settings.warnings(render->job())) {
      Json one = error_json(error, &call.studio.document());
      one["kind"] = kind;
      list.push_back(std::move(one));
    }
  if (settings.advice)
    for (const std::string& line : settings.advice(render->job())) advice.push_back(line);
  return {{"warnings", std::move(list)}, {"advice", std::move(advice)}};
}

// ---- tasks in processes of their own ----------------------------------------------------------------------------------------

std::vector<std::string> with_plugins(std::vector<std::string> arguments, const Studio& studio) {
  for (const std::string& plugin : studio.settings().plugins) arguments.insert(arguments.end(), {"--plugin", plugin});
  return arguments;
}

Json conform(const Call& call) {
  const std::string name = class_named(call.text("class")).name;
  return {{"task", call.studio.tasks().run("conform " + name, with_plugins({"conform", name, "--quick"}, call.studio))}};
}

/// Verifies the file on disk, in another process.
Json verify(const Call& call) {
  const Document& document = call.studio.document();
  if (document.file().empty() || document.changed()) throw RequestError("busy", "what is verified is the file: save it first");
  std::vector<std::string> arguments = {"verify", document.file()};
  if (call.has("renderers")) {
    const std::string renderers = call.text("renderers");
    size_t begin = 0;
    while (begin <= renderers.size()) {  // only class names: expressions might name files
      const size_t end = std::min(renderers.find(',', begin), renderers.size());
      static_cast<void>(class_named(renderers.substr(begin, end - begin)));
      begin = end + 1;
    }
    arguments.insert(arguments.end(), {"--renderers", renderers});
  }
  if (call.has("samples"))
    arguments.insert(arguments.end(), {"--samples", std::to_string(call.integer("samples", 8, 1'000'000))});
  if (call.has("size")) {
    const Json& size = call.request["size"];
    if (!size.is_array() || size.size() != 2 || !size[0].is_number_integer() || !size[1].is_number_integer())
      throw RequestError("bad_request", "'size' must be [width, height]");
    arguments.insert(arguments.end(), {"--size", fmt::format("{}x{}", size[0].get<int>(), size[1].get<int>())});
  }
  return {{"task", call.studio.tasks().run("verify " + document.file(), with_plugins(arguments, call.studio))}};
}

Json end_task(const Call& call) {
  call.studio.tasks().end(int(call.integer("task", 1, 2'000'000'000)));
  return {};
}

// ---- strategies -------------------------------------------------------------------------------------------------------------

/// The picture as linear sRGB half floats, scaled so that the largest value is near 1000.
Json picture_json(const Image& picture) {
  const LinearSrgb linear_srgb;
  double largest = 0;
  for (const double v : picture.values) largest = std::max(largest, std::abs(v));
  const double scale = largest > 0 ? std::exp2(std::ceil(std::log2(largest / 1000))) : 1;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.values.size() * 2);
  for (size_t p = 0; p + 2 < picture.values.size(); p += 3)
    for (const double v : linear_srgb(picture.values[p], picture.values[p + 1], picture.values[p + 2])) {
      const std::uint16_t half = to_half(float(v / scale));
      bytes.push_back(std::uint8_t(half));
      bytes.push_back(std::uint8_t(half >> 8));
    }
  return {{"scale", scale}, {"halfs", base64(bytes)}};
}

double mean_luminance(const Image& picture) {
  double sum = 0;
  for (size_t p = 1; p < picture.values.size(); p += 3) sum += picture.values[p];
  return sum / (double(picture.width) * double(picture.height));
}

/// Uses a small separate render, so that nothing else waits for it.
Json strategies(const Call& call) {
  Studio& studio = call.studio;
  const auto render = studio.valid_render();
  const auto samples = std::uint32_t(call.integer_or("samples", 16, 1, 4096));
  const auto wanted = int(call.integer_or("width", 160, 8, 512));
  const ImageBuffer& image = *render->job().image;
  const int width = std::min(wanted, image.width);
  const int height = std::max(1, int(std::lround(double(image.height) * width / image.width)));
  const Document& document = studio.document();
  const Ref<Job> job = load_job_text(document.text(), document.name(), document.folder());
  for (const auto& [path, expression] : document.overrides())
    if (!path.starts_with("image.")) set_path(*job, path, expression);
  set_path(*job, "image.width", std::to_string(width));
  set_path(*job, "image.height", std::to_string(height));
  set_path(*job, "image.crop", "[]");
  if (job->renderer->samples < std::int64_t(samples)) set_path(*job, "renderer.samples", std::to_string(samples));
  RenderSettings settings = studio.settings().render;
  settings.threads = 1;
  return {{"task", studio.tasks().work("strategies", [job, settings, samples, width, height](const Tasks::Work& work) -> Json {
             const Render small(job, settings);
             auto told = std::chrono::steady_clock::now();
             const auto pictures = strategy_pictures(small, samples, [&](double fraction) {
               const auto now = std::chrono::steady_clock::now();
               if (now - told > std::chrono::milliseconds(200)) {
                 told = now;
                 work.done(fraction);
               }
               return !work.ended.load();
             });
             // Limited to the data that may be queued for a page that reads slowly.
             constexpr size_t most = 24 << 20;  // [bytes]
             const size_t each = size_t(width) * size_t(height) * 16;
             Json list = Json::array();
             for (const StrategyPicture& p : pictures) {
               if ((list.size() + 1) * each > most) break;
               list.push_back({{"strategy", p.strategy},
                               {"length", p.length},
                               {"mean", mean_luminance(p.weighted)},
                               {"weighted", picture_json(p.weighted)},
                               {"unweighted", picture_json(p.unweighted)}});
             }
             return {{"width", width}, {"height", height}, {"whole", list.size() == pictures.size()}, {"strategies", list}};
           })}};
}

const RegisterRequests registered{
    {"warnings", true, warnings},      {"conform", false, conform},   {"verify", false, verify},
    {"strategies", false, strategies}, {"end_task", false, end_task},
};

}  // namespace

}  // namespace etendue::studio
