#pragma once
/// A page that needs nothing else: HTML with its style, pictures and plots within it.

#include <string>
#include <string_view>
#include <vector>

namespace palpate::tools {

/// Takes plain text everywhere and writes it as markup itself. The page is well-formed XML too.
class HtmlPage {
 public:
  explicit HtmlPage(std::string title) : title_(std::move(title)) {}

  void heading(std::string_view text);  ///< of a chapter; listed at the top of the page
  void subheading(std::string_view text);
  void paragraph(std::string_view text);
  void note(std::string_view text);  ///< something to look at
  void preformatted(std::string_view text);
  /// The heading first; columns whose cells begin with a number are set to the right.
  void table(const std::string& title, const std::vector<std::vector<std::string>>& rows);
  /// Two columns: what, and its value.
  void facts(const std::vector<std::vector<std::string>>& rows);
  void png(std::string_view bytes, std::string_view caption);
  /// As a picture of its own: its names and ids do not meet those of other pictures.
  void svg(std::string_view file, std::string_view caption);

  /// The whole file. `foot`: what it was made with.
  [[nodiscard]] std::string text(std::string_view foot) const;

 private:
  void figure(std::string_view type, std::string_view bytes, std::string_view caption);

  std::string title_;
  std::string contents_;
  std::string body_;
  int chapters_ = 0;
};

}  // namespace palpate::tools
