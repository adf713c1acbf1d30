#include <gtest/gtest.h>

#include <filesystem>

#include "lib/scene/problems.h"
#include "palpate/scene/scene_file.h"
#include "support/temp_file.h"

namespace palpate {
namespace {

using namespace std::string_literals;
using testing::TempFolder;

TEST(Document, TreeKeepsOrderQuotesAndMarks) {
  const auto document = parseDocument(
      "# a comment\n"
      "b: 1\n"
      "a:\n"
      "  - \"two\"\n"
      "  - {x: [y, 'z'], w: 010}\n",
      "test.yaml");
  const Node& root = document->root;
  ASSERT_EQ(root.kind, Node::Kind::kMap);
  ASSERT_EQ(root.entries.size(), 2U);
  EXPECT_EQ(root.entries[0].key, "b");
  EXPECT_EQ(root.entries[0].key_mark.line, 2);
  EXPECT_EQ(root.entries[0].key_mark.column, 1);
  EXPECT_EQ(root.entries[0].value.text, "1");
  EXPECT_FALSE(root.entries[0].value.quoted);
  EXPECT_EQ(root.entries[0].value.mark.column, 4);
  const Node* a = root.find("a");
  ASSERT_NE(a, nullptr);
  ASSERT_EQ(a->items.size(), 2U);
  EXPECT_TRUE(a->items[0].quoted);
  EXPECT_EQ(a->items[0].text, "two");
  EXPECT_EQ(a->items[0].mark.line, 4);
  EXPECT_EQ(a->items[0].mark.column, 5);
  const Node* x = a->items[1].find("x");
  ASSERT_NE(x, nullptr);
  ASSERT_EQ(x->items.size(), 2U);
  EXPECT_TRUE(x->items[1].quoted);
  EXPECT_EQ(x->items[1].mark.column, 13);
  EXPECT_EQ(a->items[1].find("w")->text, "010");
  EXPECT_EQ(root.find("c"), nullptr);
}

TEST(Document, ReadsJsonEvenWithTabs) {
  const auto document =
      parseDocument("{\n\t\"a\": [1, 2.5e3, true, null],\n\t\"b\":\"x\"\n}\n", "test.yaml");
  const Node* a = document->root.find("a");
  ASSERT_NE(a, nullptr);
  ASSERT_EQ(a->items.size(), 4U);
  EXPECT_EQ(a->items[1].text, "2.5e3");
  EXPECT_FALSE(a->items[1].quoted);
  EXPECT_EQ(a->items[3].kind, Node::Kind::kNull);
  EXPECT_TRUE(document->root.find("b")->quoted);
}

TEST(Document, ByteOrderMarkAndWindowsLineEndsChangeNothing) {
  const auto document = parseDocument(
      "\xEF\xBB\xBF"
      "a: 1\r\nb: two words\r\n",
      "test.yaml");
  EXPECT_EQ(document->root.find("a")->text, "1");
  EXPECT_EQ(document->root.find("b")->text, "two words");
  EXPECT_EQ(document->root.find("b")->mark.line, 2);
  EXPECT_EQ(document->root.find("a")->mark.column, 4);
  EXPECT_EQ(document->lines[1], "b: two words");
}

TEST(Document, ColumnsCountCharactersInPlaces) {
  const auto document = parseDocument("{\"\xC3\xA9\xC3\xA9\": x, b: y}", "test.yaml");
  EXPECT_EQ(document->place(document->root.find("b")->mark).column, 14);
  // The caret line's own indent of three columns precedes the excerpt's first character.
  const Error error = document->error(document->root.find("b")->mark, "code", "what");
  EXPECT_NE(std::string(error.what()).find("\n" + std::string(15, ' ') + "^"), std::string::npos)
      << error.what();
}

TEST(Document, LongLinesAreNotShownWhole) {
  const auto document =
      parseDocument("{a: 1, b: [" + std::string(500, '1') + "], c: 2}", "test.yaml");
  const SourcePlace near = document->place(document->root.find("a")->mark);
  EXPECT_LT(near.excerpt.size(), 210U);
  EXPECT_EQ(near.excerpt.substr(0, 5), "{a: 1");
  const SourcePlace far = document->place(document->root.find("c")->mark);
  EXPECT_EQ(far.column, 518);
  EXPECT_TRUE(far.excerpt.empty());
}

TEST(Document, NestingOf64IsReadAnd65IsNot) {
  const auto nested = [](std::size_t n) { return std::string(n, '[') + "1" + std::string(n, ']'); };
  EXPECT_NO_THROW((void)parseDocument(nested(64), "test.yaml"));
  const Problem problem = problemOf([&] { (void)parseDocument(nested(65), "test.yaml"); });
  EXPECT_EQ(problem.code, "document.depth");
  EXPECT_EQ(problem.column, 65);
}

class DocumentRefuses : public ::testing::TestWithParam<Refusal> {};

TEST_P(DocumentRefuses, WithItsPlace) {
  const Refusal& refusal = GetParam();
  expectRefusal(refusal, problemOf([&] { (void)parseDocument(refusal.text, "test.yaml"); }));
}

INSTANTIATE_TEST_SUITE_P(
    Each, DocumentRefuses,
    ::testing::Values(
        Refusal{"Nothing", "", 1, 1, "document.empty", "empty", ""},
        Refusal{"OnlyComments", "# a\n\n# b\n", 1, 1, "document.empty", "empty", ""},
        Refusal{"DuplicateKey", "a: 1\nb: 2\na: 3\n", 3, 1, "document.duplicate_key", "'a'",
                "line 1"},
        Refusal{"DuplicateKeyInFlow", "x: {a: 1, \"a\": 2}", 1, 11, "document.duplicate_key", "'a'",
                "line 1"},
        Refusal{"Alias", "a: &x 1\nb: 2\n", 1, 4, "document.anchor", "&", "name"},
        Refusal{"AnchoredMap", "a: &x {b: 1}\n", 1, 4, "document.anchor", "&", ""},
        Refusal{"AnchorAlone", "a: & 1\n", 1, 5, "document.anchor", "&", ""},
        Refusal{"UnquotedGlob", "match: [*CL]\n", 1, 9, "document.alias", "*", "quote globs"},
        Refusal{"UnquotedGlobInBlock", "match:\n  - *CL\n", 2, 5, "document.alias", "*",
                "quote globs"},
        Refusal{"UnquotedStar", "match: [*]\n", 1, 9, "document.alias", "*", "quote globs"},
        Refusal{"UnquotedStarsAround", "match: *CL*\n", 1, 8, "document.alias", "*", "quote globs"},
        Refusal{"UnquotedQuestionMark", "a: [n?d]\n", 1, 6, "document.syntax", "not YAML",
                "quote globs"},
        Refusal{"Tag", "a: !!int 3\n", 1, 4, "document.tag", "!", "tag"},
        Refusal{"LocalTag", "a: !mine {b: 1}\n", 1, 4, "document.tag", "!", "tag"},
        Refusal{"NonSpecificTag", "a: ! \"3\"\n", 1, 4, "document.tag", "!", "tag"},
        Refusal{"TwoDocuments", "a: 1\n---\nb: 2\n", 2, 1, "document.several", "second", "---"},
        Refusal{"ListAsKey", "? [a, b]\n: 1\n", 1, 3, "document.key", "key", "one word"},
        Refusal{"MapAsKey", "{{a: 1}: 2}\n", 1, 2, "document.key", "key", "one word"},
        Refusal{"NoKey", "{: 2}\n", 1, 1, "document.key", "key", "one word"},
        Refusal{"TabAsIndent", "a:\n\tb: 1\n", 2, 1, "document.tab", "tab", "spaces"},
        Refusal{"TabBehindColon", "a:\t1\n", 1, 3, "document.tab", "tab", "spaces"},
        Refusal{"OpenBrace", "a: {b: 1\nc: 2\n", 2, 2, "document.syntax", "not YAML", "'{'"},
        Refusal{"OpenBracket", "a: [1, 2\n", 2, 1, "document.syntax", "not YAML", "'['"},
        Refusal{"OpenQuote", "a: \"b\n", 1, 4, "document.quote", "not closed", "close it"},
        Refusal{"QuoteAcrossLines", "a: 'b\nc: d'\n", 1, 4, "document.quote", "not closed", "'|'"},
        Refusal{"OpenQuoteAtEnd", "a: \"b\\\"", 1, 8, "document.syntax", "not YAML",
                "quotation mark"},
        Refusal{"LeftOver", "{a: 1} x\n", 1, 8, "document.several",
                "does not continue anything before it", "brackets"},
        Refusal{"ColonInText", "a: b: c\n", 1, 5, "document.syntax", "not YAML", "quotes"},
        Refusal{"BadIndent", "a:\n  b: 1\n c: 2\n", 3, 2, "document.syntax", "not YAML",
                "indented"},
        Refusal{"Latin1", "a: caf\xE9\n", 1, 7, "document.encoding", "0xE9", "UTF-8"},
        Refusal{"OverlongUtf8", "a: \xC0\xAF\n", 1, 4, "document.encoding", "0xC0", "UTF-8"},
        Refusal{"Surrogate", "a: \xED\xA0\x80\n", 1, 4, "document.encoding", "0xED", "UTF-8"},
        Refusal{"Utf16",
                "\xFF\xFE"
                "a\0:\0"s,
                1, 1, "document.encoding", "0xFF", "UTF-8"},
        Refusal{"CutCharacter", "a: \xE2\x82", 1, 4, "document.encoding", "0xE2", "UTF-8"},
        Refusal{"Binary", "a: \0\x01\x02"s, 1, 4, "document.binary", "0x00", "UTF-8"},
        Refusal{"OldMacLineEnd", "a: 1\rb: 2", 1, 5, "document.binary", "0x0D", ""},
        Refusal{"TooBig", std::string((16U << 20U) + 1, '#'), 0, 0, "document.too_big", "16 MB",
                "names"}),
    refusalName);

// Deep nesting is refused before the parser's own recursion gets deep, however it is written.
TEST(Document, BombsAreRefused) {
  for (const std::string level : {"[", "{a: ", "- ", "? ", "[? ", "{a: [", "- ? ", "{{"}) {
    std::string bomb;
    for (int i = 0; i < 20000; ++i) bomb += level;
    const Problem problem = problemOf([&] { (void)parseDocument(bomb, "test.yaml"); });
    EXPECT_EQ(problem.code, "document.depth") << level;
    EXPECT_EQ(problem.line, 1) << level;
    EXPECT_NE(problem.hint.find("names of their own"), std::string::npos) << level;
  }
}

TEST(Document, QuotationMarksInQuotes) {
  const auto document =
      parseDocument("a: 'it''s'\nb: \"a \\\"b\\\" \\\\\"\n\"c\": |\n  \"open\n", "test.yaml");
  EXPECT_EQ(document->root.find("a")->text, "it's");
  EXPECT_EQ(document->root.find("b")->text, "a \"b\" \\");
  EXPECT_EQ(document->root.find("c")->text, "\"open\n");
}

TEST(Document, TheOffendingLineIsShown) {
  const Problem problem =
      problemOf([] { (void)parseDocument("a: 1\nb: [*x]   # here\n", "test.yaml"); });
  EXPECT_EQ(problem.excerpt, "b: [*x]   # here");
}

TEST(Document, ACommentMayHoldTabs) {
  EXPECT_NO_THROW((void)parseDocument("# a\tb\na: 1  #\tc\n", "test.yaml"));
}

TEST(Document, AnEmptyListEntryIsMarkedWhereItIs) {
  const auto document = parseDocument("a:\n  - 1\n  -\n  # c\n\nb: 2\n", "test.yaml");
  const Node& empty = document->root.find("a")->items[1];
  EXPECT_EQ(empty.kind, Node::Kind::kNull);
  EXPECT_EQ(empty.mark.line, 3);
  EXPECT_EQ(empty.mark.column, 3);
}

TEST(DocumentFiles, MissingFile) {
  const TempFolder folder;
  const std::string path = folder.path("none.yaml");
  const Problem problem = problemOf([&] { (void)readDocument(path); });
  EXPECT_EQ(problem.code, "document.open");
  EXPECT_EQ(problem.file, path);
  EXPECT_NE(problem.message.find("no such file"), std::string::npos);
}

TEST(DocumentFiles, Folder) {
  const TempFolder folder;
  const Problem problem = problemOf([&] { (void)readDocument(folder.path()); });
  EXPECT_EQ(problem.code, "document.open");
  EXPECT_NE(problem.message.find("folder"), std::string::npos);
}

TEST(DocumentFiles, HugeFile) {
  const TempFolder folder;
  const std::string path = folder.file("huge.yaml", "a");
  std::filesystem::resize_file(path, (std::uintmax_t{16} << 20U) + 1);  // sparse
  EXPECT_EQ(problemOf([&] { (void)readDocument(path); }).code, "document.too_big");
}

TEST(DocumentFiles, ReadsAFile) {
  const TempFolder folder;
  const std::string path = folder.file("small.yaml", "a: 1\n");
  const auto document = readDocument(path);
  EXPECT_EQ(document->file, path);
  EXPECT_EQ(document->root.find("a")->text, "1");
}

}  // namespace
}  // namespace palpate
