#include "report.h"

#include <fmt/format.h>

#include <cmath>

#include "describe/html_text.h"
#include "plot.h"
#include "tables.h"

namespace etendue::comparing {
namespace {

constexpr std::string_view style = R"(
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .9rem; margin: 1rem 0; }
th, td { padding: .3rem .8rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { font-weight: 600; vertical-align: bottom; }
th:first-child, td:first-child, .text { text-align: left; }
.text { white-space: normal; min-width: 12rem; }
.best { font-weight: 700; color: var(--good); }
.found { font-weight: 700; color: var(--bad); }
)";

std::string error_cell(const std::vector<double>& errors, bool best) {
  const std::optional<Estimate> e = mean_error(errors);
  if (!e) return "<td>–</td>";
  const std::optional<Band> b = band(*e, band_probability);
  return fmt::format("<td{}>{:.3g}{}</td>", best ? " class=\"best\"" : "", e->value,
                     b ? fmt::format(" <span class=\"quiet\">[{:.3g}, {:.3g}]</span>", b->low, b->high) : std::string());
}

std::string optional_cell(const std::optional<double>& x) {
  return x ? fmt::format("<td>{:.3f}</td>", *x) : std::string("<td>–</td>");
}

class Page {
 public:
  Page(const Results& results, const std::vector<std::string>& pictures, const std::string& command_line)
      : results_(results), pictures_(pictures), command_line_(command_line) {}

  std::string html() {
    heading();
    if (results_.scenes.size() > 1) matrix();
    for (size_t s = 0; s < results_.scenes.size(); ++s) {
      scene(results_.scenes[s], s);
      text_ += pictures_[s];
    }
    contests();
    method();
    text_ += "</body>\n</html>\n";
    return std::move(text_);
  }

 private:
  template <class... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }

  void heading() {
    add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Comparison</title>\n"
        "<style>{}{}{}{}</style>\n</head>\n<body>\n<h1>Comparison</h1>\n<p class=\"quiet\"><code>{}</code></p>\n<ul>\n",
        page_style, style, plot_style, picture_style, escaped(command_line_));
    for (const SceneResult& scene : results_.scenes) {
      add("<li><code>{}</code>: least error after {:.3g} s: <strong>{}</strong>; after {} samples: <strong>{}</strong></li>\n",
          escaped(scene.file), scene.equal_seconds, escaped(winner_text(scene, scene.at_time)), scene.equal_samples,
          escaped(winner_text(scene, scene.at_samples)));
    }
    add("</ul>\n");
  }

  void matrix() {
    const std::vector<VariantResult>& variants = results_.scenes.front().variants;
    add("<h2>All scenes</h2>\n<p>Relative mean square error at equal processor time, over that of {}.</p>\n"
        "<div class=\"scroll\"><table class=\"matrix\">\n<tr><th>scene</th>",
        escaped(variants.front().name));
    for (size_t v = 0; v < variants.size(); ++v) add("<th>{}{}</th>", legend_mark(v), escaped(variants[v].name));
    add("</tr>\n");
    for (const SceneResult& scene : results_.scenes) {
      add("<tr><td>{}</td>", escaped(scene.file));
      for (size_t v = 0; v < variants.size(); ++v) {
        const auto &errors = scene.variants[v].at_time, &first = scene.variants.front().at_time;
        const bool best = scene.at_time.variant == v && scene.at_time.significant;
        if (errors.empty() || first.empty())
          add("<td>–</td>");
        else
          add("<td{}>{:.3g}{}</td>", best ? " class=\"best\"" : "", mean_of(errors).value / mean_of(first).value,
              scene.variants[v].bias.found() ? " <span class=\"found\">biased</span>" : "");
      }
      add("</tr>\n");
    }
    add("<tr><th>geometric mean</th>");
    for (const GeometricMean& mean : results_.geometric_means)
      add("<td>{:.3g} <span class=\"quiet\">± {:.1f} %</span></td>", mean.value, 100 * mean.relative_error);
    add("</tr>\n</table></div>\n<p class=\"quiet\">Bold: significantly better than each other variant on that scene. The "
        "geometric "
        "mean is of the runs' geometric means; its error is that of the runs, on these scenes.</p>\n");
  }

  void scene(const SceneResult& scene, size_t number) {
    add("<h2 id=\"scene{}\"><code>{}</code></h2>\n<p>{} × {} pixels, {} independent runs of each variant. Reference: {}.",
        number + 1, escaped(scene.file), scene.width, scene.height, scene.runs, escaped(scene.reference));
    if (!scene.reference_is_exact) add(" Its own relative variance, {:.2g}, is subtracted from errors.", scene.reference_noise);
    add("</p>\n<div class=\"scroll\"><table>\n<tr><th>variant</th><th>relMSE after {:.3g} s</th><th>relMSE after {} "
        "samples</th>"
        "<th>SMAPE after {:.3g} s</th><th>exponent over time</th><th>over samples</th><th>samples</th><th>time [s]</th>"
        "<th class=\"text\">bias of the mean</th><th class=\"text\">remarks</th></tr>\n",
        scene.equal_seconds, scene.equal_samples, scene.equal_seconds);
    for (size_t v = 0; v < scene.variants.size(); ++v) {
      const VariantResult& r = scene.variants[v];
      add("<tr><td>{}{}</td>{}{}{}<td>{}</td><td>{}</td><td>{:.4g}</td><td>{:.3g}</td><td class=\"text{}\">{}</td>"
          "<td class=\"text\">",
          legend_mark(v), escaped(r.name), error_cell(r.at_time, scene.at_time.variant == v && scene.at_time.significant),
          error_cell(r.at_samples, scene.at_samples.variant == v && scene.at_samples.significant),
          optional_cell(r.symmetric_at_time), slope_text(r.slope_over_time), slope_text(r.slope_over_samples), r.samples,
          r.seconds, r.bias.found() ? " found" : "", escaped(bias_text(r)));
      for (const std::string& remark : remarks(scene, r)) add("{}<br>", escaped(remark));
      add("</td></tr>\n");
    }
    add("</table></div>\n<p class=\"quiet\">In brackets: the 95 % confidence interval of the mean over runs. Bold: "
        "significantly "
        "less than each other variant's.</p>\n<div class=\"plots\">\n{}{}{}{}</div>\n",
        error_plot(scene, true), error_plot(scene, false), split_plot(scene), symmetric_plot(scene));
  }

  static Series series(const VariantResult& v, size_t color, bool over_time, Estimate CurvePoint::* of) {
    Series s{v.name, {}, {}, {}, {}, color, false};
    for (const CurvePoint& p : v.curve) {
      s.x.push_back(over_time ? p.seconds : p.samples);
      s.y.push_back((p.*of).value);
      const std::optional<Band> b = band(p.*of, band_probability);
      s.low.push_back(b ? b->low : 0);
      s.high.push_back(b ? b->high : 0);
    }
    return s;
  }

  static std::string error_plot(const SceneResult& scene, bool over_time) {
    Plot plot{over_time ? "Error over processor time" : "Error over samples",
              over_time ? "processor time [s]" : "samples per pixel",
              "relMSE",
              {},
              over_time ? scene.equal_seconds : scene.equal_samples};
    for (size_t v = 0; v < scene.variants.size(); ++v)
      plot.series.push_back(series(scene.variants[v], v, over_time, &CurvePoint::error));
    return svg(plot);
  }

  static std::string symmetric_plot(const SceneResult& scene) {
    Plot plot{"SMAPE over processor time", "processor time [s]", "SMAPE", {}, scene.equal_seconds};
    for (size_t v = 0; v < scene.variants.size(); ++v)
      plot.series.push_back(series(scene.variants[v], v, true, &CurvePoint::symmetric));
    return svg(plot);
  }

  static std::string split_plot(const SceneResult& scene) {
    Plot plot{"Variance (solid) and squared bias (dashed)", "samples per pixel", "part of relMSE", {}, 0};
    for (size_t v = 0; v < scene.variants.size(); ++v) {
      const VariantResult& r = scene.variants[v];
      Series variance{r.name + ", variance", {}, {}, {}, {}, v, false},
          bias{r.name + ", squared bias", {}, {}, {}, {}, v, true};
      for (const CurvePoint& p : r.curve) {
        variance.x.push_back(p.samples);
        variance.y.push_back(p.variance);
        // Only where the squared bias is significant.
        if (!r.bias.known || !(p.square_bias.value > 2 * p.square_bias.error)) continue;
        bias.x.push_back(p.samples);
        bias.y.push_back(p.square_bias.value);
      }
      plot.series.push_back(std::move(variance));
      if (!bias.x.empty()) plot.series.push_back(std::move(bias));
    }
    return svg(plot);
  }

  void contests() {
    add("<h2>Each against each</h2>\n<div class=\"scroll\"><table>\n<tr><th>scene</th><th class=\"text\">A</th><th "
        "class=\"text\">B</th><th>relMSE of A / B, equal time</th><th>corrected p</th><th>equal samples</th><th>corrected "
        "p</th></tr>\n");
    const auto cells = [](const Contest* c) {
      if (!c) return std::string("<td>–</td><td>–</td>");
      return fmt::format("<td{}>{:.3g}</td><td>{:.2g}</td>", c->significant ? " class=\"best\"" : "", c->ratio, c->corrected);
    };
    const auto find = [](const std::vector<Contest>& list, size_t scene, size_t a, size_t b) -> const Contest* {
      for (const Contest& c : list)
        if (c.scene == scene && c.a == a && c.b == b) return &c;
      return nullptr;
    };
    for (size_t s = 0; s < results_.scenes.size(); ++s)
      for (size_t a = 0; a < results_.scenes[s].variants.size(); ++a)
        for (size_t b = a + 1; b < results_.scenes[s].variants.size(); ++b)
          add("<tr><td>{}</td><td class=\"text\">{}</td><td class=\"text\">{}</td>{}{}</tr>\n",
              escaped(results_.scenes[s].file), escaped(results_.scenes[s].variants[a].name),
              escaped(results_.scenes[s].variants[b].name), cells(find(results_.at_time, s, a, b)),
              cells(find(results_.at_samples, s, a, b)));
    add("</table></div>\n<p class=\"quiet\">{}.</p>\n", escaped(significance_text(results_)));
  }

  void method() {
    add("<h2>How this was computed</h2>\n<ul>\n"
        "<li>Each variant made independent runs, whole renders with random numbers of their own, in turns. Time is that of the "
        "processor, on all threads. Errors at a time or number of samples between two looks are read from a line between them "
        "on "
        "logarithmic scales.</li>\n"
        "<li>relMSE = mean of (x − r)² / (r² + ε) over X, Y and Z of all pixels, ε = 0.01 (mean r)². SMAPE = mean of 2 |x − r| "
        "/ (|x| + "
        "|r|), from 0 to 2.</li>\n"
        "<li>Variance and squared bias are the two parts of relMSE: what differs from run to run, and what does not. The "
        "latter comes from "
        "products of different runs' differences from the reference, less the reference's own variance. It is shown where it "
        "is "
        "more than twice its standard error.</li>\n"
        "<li>Exponents are those of least squares lines through the logarithms of the runs' mean errors; their errors are by "
        "the "
        "jackknife over runs. −1 is what independent samples give.</li>\n"
        "<li>Whether a mean is biased is tested by tiles and in the whole picture, as <code>etendue verify</code> does, at the "
        "significance {} for all variants and scenes together.</li>\n"
        "</ul>\n<p>docs/compare.md has the formulas and their sources.</p>\n",
        results_.significance);
  }

  const Results& results_;
  const std::vector<std::string>& pictures_;
  const std::string& command_line_;
  std::string text_;
};

}  // namespace

std::string html_report(const Results& results, const std::vector<std::string>& pictures, const std::string& command_line) {
  return Page(results, pictures, command_line).html();
}

}  // namespace etendue::comparing
