#include "report_page/html_page.h"

#include <algorithm>

#include "markup.h"

namespace palpate::tools {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light; }
body { font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 1100px;
  margin: 2rem auto; padding: 0 1.5rem; }
h1 { font-size: 1.7rem; margin: 0 0 0.5rem; }
h2 { font-size: 1.35rem; margin: 3rem 0 0.5rem; border-bottom: 2px solid #1f4fb0; }
h3 { font-size: 1.05rem; margin: 1.8rem 0 0.4rem; }
h1, h2, h3, p, td, th, figcaption { overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.86rem; margin: 0.3rem 0 1rem; }
th, td { border-bottom: 1px solid #ddd; padding: 0.2rem 0.9rem 0.2rem 0; text-align: left;
  vertical-align: top; }
th { border-bottom: 2px solid #999; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
figure { margin: 1rem 0; }
img { max-width: 100%; height: auto; border: 1px solid #ddd; }
figcaption { font-size: 0.86rem; color: #555; }
.note { border-left: 4px solid #b45309; padding: 0.2rem 0.8rem; background: #fdf6ec; }
pre { overflow-x: auto; background: #f6f6f4; padding: 0.6rem 0.8rem; font-size: 0.82rem; }
footer { margin: 3rem 0 1rem; border-top: 1px solid #ddd; color: #555; font-size: 0.86rem; }
@media print { body { max-width: none; margin: 0; } h2 { break-before: page; } }
)";

bool isNumeric(const std::string& text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.empty()) return false;
  if (text == "-") return true;
  return is_digit(text[0]) || (text[0] == '-' && text.size() > 1 && is_digit(text[1]));
}

std::string element(const char* name, std::string_view text) {
  return "<" + std::string(name) + ">" + markupText(text) + "</" + name + ">";
}

}  // namespace

void HtmlPage::heading(std::string_view text) {
  const std::string id = "chapter-" + std::to_string(++chapters_);
  contents_ += "<li><a href=\"#" + id + "\">" + markupText(text) + "</a></li>\n";
  body_ += "<h2 id=\"" + id + "\">" + markupText(text) + "</h2>\n";
}

void HtmlPage::subheading(std::string_view text) { body_ += element("h3", text) + "\n"; }

void HtmlPage::paragraph(std::string_view text) { body_ += element("p", text) + "\n"; }

void HtmlPage::note(std::string_view text) {
  body_ += "<p class=\"note\">" + markupText(text) + "</p>\n";
}

void HtmlPage::preformatted(std::string_view text) { body_ += element("pre", text) + "\n"; }

void HtmlPage::table(const std::string& title, const std::vector<std::vector<std::string>>& rows) {
  if (!title.empty()) subheading(title);
  if (rows.size() < 2) {
    paragraph("none");
    return;
  }
  const auto is_to_the_right = [&](std::size_t column) {
    return std::all_of(rows.begin() + 1, rows.end(), [&](const auto& row) {
      return column >= row.size() || isNumeric(row[column]);
    });
  };
  std::vector<const char*> tags;
  for (std::size_t i = 0; i < rows.front().size(); ++i) {
    tags.push_back(is_to_the_right(i) ? " class=\"number\">" : ">");
  }
  body_ += "<div class=\"wide\"><table>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::string name = r == 0 ? "th" : "td";
    body_ += "<tr>";
    for (std::size_t i = 0; i < rows[r].size(); ++i) {
      body_ += "<" + name + (i < tags.size() ? tags[i] : ">") + markupText(rows[r][i]) + "</" +
               name + ">";
    }
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
}

void HtmlPage::facts(const std::vector<std::vector<std::string>>& rows) {
  body_ += "<div class=\"wide\"><table>\n";
  for (const auto& row : rows) {
    body_ += "<tr>";
    for (const std::string& cell : row) body_ += element("td", cell);
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
}

void HtmlPage::png(std::string_view bytes, std::string_view caption) {
  figure("image/png", bytes, caption);
}

void HtmlPage::svg(std::string_view file, std::string_view caption) {
  figure("image/svg+xml", file, caption);
}

void HtmlPage::figure(std::string_view type, std::string_view bytes, std::string_view caption) {
  body_ += "<figure><img alt=\"" + markupText(caption) + "\" src=\"data:" + std::string(type) +
           ";base64," + base64(bytes) + "\" />\n" + element("figcaption", caption) + "</figure>\n";
}

std::string HtmlPage::text(std::string_view foot) const {
  // Even if a name in a file smuggled in markup, it could not load or run anything: the policy
  // allows this style only.
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\" />\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'\" />\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n";
  out += element("title", title_) + "\n<style>" + kStyle + "</style>\n</head>\n<body>\n";
  out += element("h1", title_) + "\n";
  if (chapters_ > 1) out += "<ul>\n" + contents_ + "</ul>\n";
  return out + body_ + "<footer>" + element("pre", foot) + "</footer>\n</body>\n</html>\n";
}

}  // namespace palpate::tools
