#include "lab/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lab/base/base64.h"
#include "lab/base/build_info.h"
#include "lab/report/html.h"
#include "lab/report/paper_html.h"
#include "lab/report/static_tables.h"
#include "lab/results/results.h"
#include "pipeline/image/metrics.h"

namespace hwsim::lab {
namespace {

// No request can leave the page, whatever stands in it.
constexpr std::string_view kPolicy =
    "default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'; script-src 'unsafe-inline' "
    "'wasm-unsafe-eval'; base-uri 'none'; form-action 'none'";
constexpr std::size_t kSpareBytes = 50'000;

/// Values are kept as gray; this filter shows them in the colors of the error maps, without a script.
std::string magma_filter() {
  constexpr int kStops = 33;
  std::array<std::string, 3> channels;
  for (int i = 0; i < kStops; ++i) {
    const glm::vec3 color = pipeline::magma(static_cast<float>(i) / (kStops - 1));
    for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)] += fmt::format("{:.3f} ", color[c]);
  }
  std::string html =
      "<svg class=\"defs\" width=\"0\" height=\"0\" aria-hidden=\"true\"><filter id=\"magma\" "
      "color-interpolation-filters=\"sRGB\"><feComponentTransfer>";
  for (const char* name : {"R", "G", "B"})
    html += fmt::format("<feFunc{} type=\"table\" tableValues=\"{}\"/>", name,
                        channels[static_cast<std::size_t>(std::string_view("RGB").find(name))]);
  return html + "</feComponentTransfer></filter></svg>\n";
}

std::string header_of(const Report& report, const PageParts& parts) {
  const BuildInfo build = build_info();
  std::string html = fmt::format(
      "<header><p class=\"kind\">hwsim report</p><h1>{}</h1>\n<p class=\"answer\" "
      "id=\"answer\">{}</p>\n",
      html_text(report.title), html_text(answer_of(report)));
  if (!report.command.empty())
    html += fmt::format("<p class=\"command\"><span>again</span> <code id=\"command\">{}</code></p>\n",
                        html_text(report.command));
  html += fmt::format("<p class=\"build\">hwsim {}, commit {}. Intervals hold 90 %.</p>",
                      html_text(build.version), html_text(build.commit));
  html += "<aside class=\"limits\" id=\"limits\"><h2>Before you lean on it</h2><ul>";
  for (const std::string& limit : report.limits) html += "<li>" + html_text(limit) + "</li>";
  html +=
      "<li>Not modeled: data that stays in caches from one pass to the next (a large L2 or last-level cache "
      "saves more "
      "than is said), queues of more than one process, thermal limits, and drivers beyond their documented "
      "costs.</li>";
  for (const std::string& missing : parts.missing)
    html += "<li class=\"missing\">This page lacks " + html_text(missing) + ".</li>";
  return html + "</ul></aside></header>\n";
}

std::string section(std::string_view id, std::string_view title, std::string_view about,
                    const std::string& fixed) {
  return fmt::format(
      "<section id=\"{0}\"><h2>{1}</h2><p class=\"about\">{2}</p><div class=\"mount\" "
      "id=\"mount-{0}\"></div><div class=\"static\">{3}</div></section>\n",
      id, title, about, fixed);
}

/// A table of each point; those behind the first one are folded.
template <class Function>
std::string tables_of_points(const Report& report, const Function& table_of) {
  std::string html;
  for (std::size_t i = 0; i < report.points.size(); ++i)
    html += fmt::format("<details{}><summary>{}</summary>{}</details>\n", i == 0 ? " open" : "",
                        html_text(label_of(report.points[i])),
                        html_table(table_of(report.points[i]), label_of(report.points[i])));
  return html;
}

struct NamedPicture {
  std::string id, caption;
  const Picture* picture = nullptr;
};

std::vector<NamedPicture> pictures_of(const Report& report) {
  std::vector<NamedPicture> pictures;
  for (std::size_t i = 0; i < report.references.size(); ++i)
    pictures.push_back({fmt::format("reference-{}", i), "reference", &report.references[i]});
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    const ReportedPoint& point = report.points[i];
    const PointPictures& own = point.pictures;
    pictures.push_back({fmt::format("color-{}", i), label_of(point), &own.color});
    pictures.push_back({fmt::format("flip-{}", i), label_of(point) + ", error (FLIP, 0 to 1)", &own.flip});
    pictures.push_back(
        {fmt::format("heat-{}", i),
         fmt::format("{}, shader invocations a pixel, 0 to {:.0f}", label_of(point), own.heat.full_scale),
         &own.heat});
  }
  std::erase_if(pictures, [](const NamedPicture& p) { return p.picture->empty(); });
  return pictures;
}

std::string figures_of(const Report& report, std::size_t budget_bytes) {
  const std::vector<NamedPicture> pictures = pictures_of(report);
  std::vector<const Picture*> plain;
  for (const NamedPicture& picture : pictures) plain.push_back(picture.picture);
  PictureFit fit;
  const std::vector<EncodedPicture> encoded = encode_within(plain, budget_bytes, fit);
  if (pictures.empty()) return "<p>The run kept no images.</p>";
  std::string html = fmt::format(
      "<p class=\"note\">JPEG of quality {}{}. The run's folder has the exact pixels.</p><div "
      "class=\"figures\">",
      fit.quality, fit.scale < 1.0 ? fmt::format(", at {:.0f} % of its sides", 100.0 * fit.scale) : "");
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (encoded[i].uri.empty()) continue;
    html += fmt::format(
        "<figure><img id=\"{}\" width=\"{}\" height=\"{}\" loading=\"lazy\" class=\"{}\" alt=\"{}\" "
        "src=\"{}\"><figcaption>{}</figcaption></figure>\n",
        pictures[i].id, encoded[i].width, encoded[i].height,
        pictures[i].picture->channels == 1 ? "value" : "color", html_text(pictures[i].caption),
        encoded[i].uri, html_text(pictures[i].caption));
  }
  return html + "</div>";
}

std::string studies_of(const Report& report) {
  std::string html;
  if (report.rankings.size() > 1)
    html += section("overall", "Which technique in all views",
                    "The worst verdict, the largest cost and the mean error of each technique.",
                    html_table(overall_table(overall(report.rankings)), "overall") +
                        html_table(best_table(report.rankings), "best"));
  if (!report.rankings.empty())
    html += section("ranking", "Which technique", "Time, memory and error of the image, the best first.",
                    html_table(report.rankings.size() > 1 ? joined_table(report.rankings)
                                                          : ranking_table(report.rankings.front()),
                               "ranking"));
  if (report.comparison)
    html +=
        section("comparison", "What changed", "A change is (new - old) / |old| against the first row.",
                html_table(frame_comparison(*report.comparison), "frames") + "<details><summary>by pass" +
                    "</summary>" + html_table(pass_comparison(*report.comparison), "passes") + "</details>");
  if (report.sweep)
    html += section(
        "sweep", "Sweep",
        "What its points show together; the hardware above starts from the first point of each technique "
        "and GPU.",
        html_table(choice_table(report.sweep->findings.best), "the fastest") +
            html_table(effect_table(report.sweep->findings.effects), "what mattered") +
            "<details><summary>points, 2,000 at most</summary>" + html_table(report.sweep->rows, "points") +
            "</details>");
  return html;
}

std::string belief_of(const Belief& belief) {
  if (belief.times.empty())
    return "<p>This configuration holds no fit, so nothing says how far times are off.</p>";
  const auto folded = [](const char* name, const Table& table) {
    return table.rows.empty()
               ? std::string()
               : fmt::format("<details><summary>{0}</summary>{1}</details>\n", name, html_table(table, name));
  };
  return html_table(error_table(belief), "errors on what no fit saw") +
         folded("published times", published_table(belief)) +
         folded("published ratios", ratio_table(belief.ratios)) +
         folded("other renderers", external_table(belief));
}

std::string belief_section(const Report& report) {
  return section(
      "belief", "Can I believe it",
      "Published times and ratios beside predictions by fits that had not seen their scene; below them "
      "other renderers' times, which no fit saw.",
      belief_of(report.belief));
}

/// Everything but the pictures, whose place is between the two.
struct Body {
  std::string before, after;
};

/// A page of a paper's tables: it holds no frame that could be moved.
Body paper_body(const Report& report) {
  Body body{.before = "<main>\n", .after = {}};
  std::string tables;
  for (const PaperTable& table : report.paper_tables) tables += html_paper_table(table, *report.reproduction);
  body.before +=
      section("paper", "The paper's tables",
              "Published, then predicted, then the error. Bold: the published value lies outside of the "
              "prediction's 90 % interval.",
              tables + paper_notes(*report.reproduction));
  if (const auto ratios = ratios_of(report.belief, report.reproduction->paper); !ratios.empty())
    body.before += section(
        "order", "Who is faster than whom",
        fmt::format("Pairs of techniques of one table, scene and GPU, by fits that had not seen the "
                    "scene: {} of {} are in the published order.",
                    in_published_order(ratios), ratios.size()),
        "<details><summary>every pair</summary>" + html_table(ratio_table(ratios), "pairs") + "</details>");
  body.before +=
      section("residuals", "Where it errs", "Predicted over published, by stage and technique.",
              "<details><summary>every row</summary>" +
                  html_table(short_reproduction_table(*report.reproduction), "rows") + "</details>");
  body.after = belief_section(report) + "</main>\n";
  return body;
}

std::string frame_sections(const Report& report) {
  const auto tables = [&](Table (*table_of)(const ReportedPoint&)) {
    return tables_of_points(report, table_of);
  };
  return section("units", "Units and passes",
                 "How much of a pass's time each unit has to work: above 80 % it is close to its peak.",
                 "<p>The tables of passes above have the shares.</p>") +
         section("bytes", "DRAM bytes by stream", "Which data a pass moves.", tables(byte_table)) +
         section("roofline", "Roofline", "Arithmetic of each pass against its bytes from DRAM.",
                 "<p>Drawn with scripts.</p>") +
         section("tornado", "What matters", "Exact derivatives of the frame's time.",
                 tables(influence_table)) +
         section("memory", "Memory over the frame", "What is alive in each pass.", tables(memory_table)) +
         section("flow", "Raster data flow", "What enters a stage, what it kills, what leaves it.",
                 tables(flow_table));
}

Body body_of(const Report& report) {
  if (report.points.empty()) return paper_body(report);
  Body body{.before = "<main>\n", .after = {}};
  body.before +=
      section("hardware", "Move the hardware",
              "The program's own timing engine replays the counted work of a frame, here in the page.",
              html_table(point_table(report), "points") +
                  tables_of_points(report, [](const ReportedPoint& point) { return pass_table(point); }));
  body.before += studies_of(report);
  body.before += section("pareto", "Error against time", "Below and left is better.",
                         "<p>The table of points above has both.</p>");
  body.after = frame_sections(report) + belief_section(report) + "</main>\n";
  return body;
}

std::string scripts_of(const Report& report, const PageParts& parts) {
  if (parts.script.empty()) return {};
  std::string html =
      "<script type=\"application/json\" id=\"report-data\">" + script_json(to_json(report)) + "</script>\n";
  const std::span<const char> engine(parts.engine);
  html += "<script type=\"text/plain\" id=\"report-engine\">" +
          base64({reinterpret_cast<const std::uint8_t*>(engine.data()), engine.size()}) + "</script>\n";
  return html + "<script>" + parts.script + "</script>\n";
}

std::string head_of(const Report& report, const PageParts& parts) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta "
      "http-equiv=\"Content-Security-Policy\" content=\"{}\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><meta name=\"color-scheme\" content=\"light "
      "dark\"><title>{}</title><style>{}</style></head><body>\n",
      kPolicy, html_text(report.title), parts.style);
}

}  // namespace

std::string page_of(const Report& report, const PageParts& parts) {
  const Body body = body_of(report);
  const std::string start = head_of(report, parts) + magma_filter() + header_of(report, parts) + body.before;
  const std::string end = body.after + scripts_of(report, parts) + "</body></html>\n";
  const std::size_t used = start.size() + end.size() + kSpareBytes;
  const std::size_t budget = kPageBytesMax > used ? kPageBytesMax - used : 0;
  if (report.points.empty()) return start + end;
  return start +
         section("pictures", "Pictures", "Color, error against the ray-traced reference, and shading.",
                 figures_of(report, budget)) +
         end;
}

}  // namespace hwsim::lab
