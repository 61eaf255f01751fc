#include "report.h"

#include <fmt/format.h>

#include "describe/html_text.h"
#include "report_pictures.h"

namespace etendue::verify {
namespace {

constexpr std::string_view style = R"(
.agree { color: var(--good); } .undecided { color: var(--open); } .DISAGREE { color: var(--bad); }
.agree, .undecided, .DISAGREE { font-weight: 600; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .9rem; }
th, td { padding: .3rem .8rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { font-weight: 600; vertical-align: bottom; }
th:first-child, td:first-child, .text { text-align: left; }
.text { white-space: normal; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; margin: 1rem 0; }
figure { margin: 0; padding: .6rem; background: var(--panel); border-radius: .3rem; }
figure img { display: block; image-rendering: pixelated; width: 11rem; }
.large img { width: 16rem; }
figcaption { font-size: .85rem; margin-top: .4rem; max-width: 16rem; }
.scale { width: 18rem; font-size: .8rem; }
.scale .bar { height: .8rem; border: 1px solid var(--line); }
.scale .ends { display: flex; justify-content: space-between; }
)";

/// The verdict as a coloured word.
std::string badge(Verdict verdict) { return fmt::format("<span class=\"{0}\">{0}</span>", name(verdict)); }

std::string p_text(double p) { return p >= 1 ? "1" : p < 1e-99 ? "&lt; 1e-99" : fmt::format("{:.2g}", p); }

std::string ratio_text(const MeanTest& test) { return test.mean_b != 0 ? fmt::format("{:.5f}", test.ratio()) : "–"; }

std::string test_cells(const MeanTest& t) {
  return fmt::format("<td>{:.5g}</td><td>{:.5g}</td><td>{}</td><td>{:+.1f}</td><td>{}</td>", t.mean_a, t.mean_b, ratio_text(t),
                     t.z, p_text(t.corrected));
}

class Report {
 public:
  Report(const ReportContext& context, const Choice& choice, const Collected& collected, const Agreement& agreement)
      : context_(context), choice_(choice), collected_(collected), agreement_(agreement), layout_(collected.layout) {}

  std::string html() {
    heading();
    renderers();
    for (const PairAgreement& pair : agreement_.pairs) pair_section(pair);
    method();
    add("</body>\n</html>\n");
    return std::move(text_);
  }

 private:
  template <class... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }
  std::string renderer(size_t i) const { return escaped(collected_.measured[i].name); }

  void heading() {
    Verdict worst = Verdict::agrees;
    for (const PairAgreement& pair : agreement_.pairs) worst = std::max(worst, pair.verdict);
    add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>Do they agree? {}</title>\n<style>{}{}</style>\n</head>\n<body>\n",
        escaped(context_.file), page_style, style);
    add("<h1>Do the renderers agree on <code>{}</code>?</h1>\n<p class=\"quiet\"><code>{}</code></p>\n", escaped(context_.file),
        escaped(context_.command_line));
    constexpr std::string_view words[] = {"They agree.", "No disagreement, but not everything could be decided.",
                                          "They do not all agree."};
    add("<p><span class=\"{}\">{}</span> {} comparisons at a significance of {} for all of them together.</p>\n", name(worst),
        words[size_t(worst)], agreement_.tests, agreement_.significance);
    add("<div class=\"scroll\"><table>\n<tr><th>pair</th><th>verdict</th><th>mean A / B</th><th>would notice a difference of"
        "</th></tr>\n");
    for (const PairAgreement& pair : agreement_.pairs)
      add("<tr><td><a href=\"#pair{0}-{1}\">{2} and {3}</a></td><td>{4}</td><td>{5}</td><td>{6}</td></tr>\n", pair.a, pair.b,
          renderer(pair.a), renderer(pair.b), badge(pair.verdict), ratio_text(pair.tests[layout_.whole()]), noticeable(pair));
    add("</table></div>\n");
  }

  static std::string noticeable(const PairAgreement& pair) {
    return std::isfinite(pair.noticeable) ? fmt::format("{:.3g} %", 100 * pair.noticeable) : "nothing: it is black";
  }

  void renderers() {
    add("<h2>Renderers</h2>\n<div class=\"scroll\"><table>\n<tr><th>renderer</th><th>mean Y</th><th>relative standard "
        "error</th>"
        "<th>passes</th><th>time [s]</th><th>Msamples/s</th><th class=\"text\">remarks</th></tr>\n");
    for (size_t i = 0; i < collected_.measured.size(); ++i) {
      const MeanLight light = mean_light(layout_, collected_.measured[i]);
      const RendererRun& run = collected_.runs[i];
      add("<tr><td>{}</td><td>{:.6g}</td><td>{:.3f} %</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td "
          "class=\"text\">{}</td></tr>\n",
          renderer(i), light.mean, 100 * light.relative_error, collected_.measured[i].passes.size(), run.seconds,
          double(run.samples) / std::max(run.seconds, 1e-9) * 1e-6,
          escaped(remark(collected_.measured[i], run, choice_.candidates[i])));
    }
    add("</table></div>\n");
    if (!choice_.left_out.empty()) {
      add("<p>Left out:</p>\n<ul>\n");
      for (const LeftOut& left : choice_.left_out) add("<li>{}: {}</li>\n", escaped(left.name), escaped(left.reason));
      add("</ul>\n");
    }
    if (!context_.tone_map) return;
    add("<div class=\"pictures large\">\n");
    for (size_t i = 0; i < collected_.runs.size(); ++i)
      add("<figure><img alt=\"picture by {0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>\n", renderer(i),
          displayed_picture(collected_.runs[i].picture, *context_.tone_map));
    add("</div>\n<p class=\"quiet\">Shown through {}.</p>\n", escaped(context_.tone_map->class_info().name));
  }

  void pair_section(const PairAgreement& pair) {
    add("<h2 id=\"pair{}-{}\">A: {}, B: {}: {}</h2>\n", pair.a, pair.b, renderer(pair.a), renderer(pair.b),
        badge(pair.verdict));
    add("<p>A difference of {} of the whole picture's light would have been noticed with a probability of 95 %.</p>\n",
        noticeable(pair));
    const std::vector<LayerSummary> layers = summarize(layout_, pair);
    add("<div class=\"scroll\"><table>\n<tr><th>whole picture</th><th>mean of A</th><th>mean of B</th><th>A / B</th><th>z</th>"
        "<th>corrected p</th><th>tiles that disagree</th><th>undecided</th><th>verdict</th></tr>\n");
    for (const LayerSummary& s : layers)
      add("<tr><td>{}</td>{}<td>{}</td><td>{}</td><td>{}</td></tr>\n", layer_text(layout_, s.layer), test_cells(*s.whole),
          s.disagreeing_tiles, s.undecided_tiles, badge(s.verdict));
    add("</table></div>\n");
    if (const std::optional<PairConvergence> c = convergence_of(collected_, pair))
      add("<p>{}: {}.</p>\n", renderer(c->renderer), escaped(convergence_text(c->convergence)));
    maps(pair, layers);
    tests(pair, Verdict::disagrees, "What disagrees");
    tests(pair, Verdict::undecided, "What is undecided");
  }

  void maps(const PairAgreement& pair, const std::vector<LayerSummary>& layers) {
    add("<div class=\"pictures\">\n");
    for (const LayerSummary& s : layers) {
      double low = 0, high = 0;
      for (const MeanTest& test : pair.tests)
        if (test.layer == s.layer && test.place != layout_.whole()) low = std::min(low, test.z), high = std::max(high, test.z);
      const std::string layer = layer_text(layout_, s.layer);
      add("<figure><img alt=\"z of each tile, {0}\" src=\"{1}\"><figcaption>{0}<br><span class=\"quiet\">z from {2:.1f} to "
          "{3:.1f}</span></figcaption></figure>\n",
          layer, difference_map(layout_, pair, s.layer), low, high);
    }
    std::string stops;
    for (int z = -5; z <= 5; ++z) {
      const auto color = difference_color(z);
      stops += fmt::format(",rgb({} {} {})", color[0], color[1], color[2]);
    }
    add("</div>\n<div class=\"scale\"><div class=\"bar\" style=\"background:linear-gradient(90deg{})\"></div>"
        "<div class=\"ends\"><span>z −5: A darker</span><span>0</span><span>+5: A brighter</span></div></div>\n"
        "<p class=\"quiet\">Black frames: disagreement. Grey frames: undecided. Where all is well, z spreads no more than a "
        "normal "
        "distribution: at most one tile in twenty beyond ±2.</p>\n",
        stops);
  }

  void tests(const PairAgreement& pair, Verdict verdict, std::string_view title) {
    const std::vector<const MeanTest*> list = tests_with(pair, verdict);
    if (list.empty()) return;
    constexpr size_t most = 100;
    add("<h3>{}</h3>\n<div class=\"scroll\"><table>\n<tr><th>where</th><th class=\"text\">light</th><th>mean of A</th>"
        "<th>mean of B</th><th>A / B</th><th>z</th><th>corrected p</th>{}</tr>\n",
        title, verdict == Verdict::undecided ? "<th class=\"text\">why</th>" : "");
    for (size_t i = 0; i < std::min(list.size(), most); ++i) {
      const MeanTest& t = *list[i];
      add("<tr><td>{}</td><td class=\"text\">{}</td>{}", place_text(layout_, t.place), layer_text(layout_, t.layer),
          test_cells(t));
      if (verdict == Verdict::undecided) add("<td class=\"text\">{}</td>", doubt_text(t.doubt));
      add("</tr>\n");
    }
    add("</table></div>\n");
    if (list.size() > most) add("<p class=\"quiet\">and {} more</p>\n", list.size() - most);
  }

  void method() {
    add("<h2>How this was computed</h2>\n<ul>\n"
        "<li>Each renderer made independent passes, whole renders with random numbers of their own, with a box filter. What is "
        "compared are the passes' means of CIE Y (of all light also X and Z), over tiles and over the whole picture, for all "
        "light together and for each path length. A path from a luminaire straight to the camera has length 1.</li>\n"
        "<li>Two means are compared by Welch's t-test on the passes. Where light comes in rare, large contributions, means "
        "from "
        "which some are missing have too small a variance; the lower renderer's variance is therefore raised by the size of "
        "the "
        "contributions seen in the picture times what it lacks. Differences that the plain test calls significant and this one "
        "does not are <em>undecided</em>.</li>\n"
        "<li>All {} p-values are corrected together by Holm's method: if all renderers have the same expectations, the "
        "probability of any disagreement being reported is at most {}. Half of it goes to the mean Y of the whole picture, a "
        "quarter to its other means, a quarter to the tiles.</li>\n"
        "<li>z is the p-value before that correction, in standard deviations of a normal distribution.</li>\n"
        "<li>Differences below 1e-5 of the light, or 1e-7 of the picture's mean, count as none: they are float "
        "arithmetic.</li>\n"
        "</ul>\n<p>docs/verify.md has the formulas and their sources.</p>\n",
        agreement_.tests, agreement_.significance);
  }

  const ReportContext& context_;
  const Choice& choice_;
  const Collected& collected_;
  const Agreement& agreement_;
  const Layout& layout_;
  std::string text_;
};

}  // namespace

std::string html_report(const ReportContext& context, const Choice& choice, const Collected& collected,
                        const Agreement& agreement) {
  return Report(context, choice, collected, agreement).html();
}

}  // namespace etendue::verify
