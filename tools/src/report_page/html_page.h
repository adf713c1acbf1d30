#pragma once
/// A self-contained HTML page, with its style, pictures and plots in it.

#include <string>
#include <string_view>
#include <vector>

namespace palpate::tools {

/// Takes plain text everywhere and escapes it itself. The page is well-formed XML, too.
class HtmlPage {
 public:
  explicit HtmlPage(std::string title) : title_(std::move(title)) {}

  void heading(std::string_view text);  ///< of a chapter; listed at the top of the page
  void subheading(std::string_view text);
  void paragraph(std::string_view text);
  void note(std::string_view text);  ///< something that deserves attention
  void preformatted(std::string_view text);
  /// The heading row comes first; columns whose cells begin with a number are right-aligned.
  void table(const std::string& title, const std::vector<std::vector<std::string>>& rows);
  /// A table of two columns: name and value.
  void facts(const std::vector<std::vector<std::string>>& rows);
  void png(std::string_view bytes, std::string_view caption);
  /// Embeds an SVG file as a separate picture, so that its names and ids cannot clash with those of
  /// others.
  void svg(std::string_view file, std::string_view caption);

  /// The whole file. `foot`: how it was made.
  [[nodiscard]] std::string text(std::string_view foot) const;

 private:
  void figure(std::string_view type, std::string_view bytes, std::string_view caption);

  std::string title_;
  std::string contents_;
  std::string body_;
  int chapters_ = 0;
};

}  // namespace palpate::tools
