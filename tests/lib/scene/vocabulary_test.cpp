// The reader, the schema and the reference page know the same words. The words that palpate::vdb
// adds are checked against the schema by its own tests; here stand-in readers read the same keys.

#include <gtest/gtest.h>
#include <regex.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "folders/folders.h"
#include "lib/scene/stand_in_readers.h"
#include "support/scene_vocabulary.h"

namespace palpate {
namespace {

using testing::allSchemaKeys;
using testing::kNoKey;
using testing::readerKeys;
using testing::schemaKeys;

struct Probe {
  const char* definition;  ///< of the schema
  std::string scene;       ///< with '@' where the unknown key goes
};

const std::vector<Probe>& probes() {
  const auto field = [](const std::string& value) { return "fields: {f: " + value + "}\n"; };
  const std::string ball = "{sphere: {center: [0, 0, 0], radius: 1}}";
  const std::string layers = "layers:\n  - {name: a, inside: " + ball + "}\n";
  static const std::vector<Probe> probes = {
      {"", "@\n"},
      {"field_kind", field("{@}")},
      {"half_space", field("{half_space: {point: [0, 0, 0], normal: [0, 0, 1], @}}")},
      {"sphere", field("{sphere: {center: [0, 0, 0], radius: 1, @}}")},
      {"box", field("{box: {center: [0, 0, 0], size: [1, 1, 1], @}}")},
      {"rounded_box", field("{rounded_box: {center: [0, 0, 0], size: [3, 3, 3], rounding: 1, @}}")},
      {"cone", field("{cone: {base: [0, 0, 0], axis: [0, 0, 1], radius: 1, height: 1, @}}")},
      {"torus", field("{torus: {center: [0, 0, 0], axis: [0, 0, 1], radius: 2, tube: 1, @}}")},
      {"capsule", field("{capsule: {from: [0, 0, 0], to: [0, 0, 1], radius: 1, @}}")},
      {"heart", field("{heart: {center: [0, 0, 0], width: 1, @}}")},
      {"quadric", field("{quadric: {center: [0, 0, 0], xx: 1, @}}")},
      {"gyroid", field("{gyroid: {center: [0, 0, 0], period: 1, @}}")},
      {"metaballs",
       field("{metaballs: {fall_off: wyvill, iso: 0.5, balls: [{center: [0, 0, 0], radius: 1}], "
             "@}}")},
      {"metaball",
       field("{metaballs: {fall_off: wyvill, iso: 0.5, balls: [{center: [0, 0, 0], radius: 1, "
             "@}]}}")},
      {"smooth", field("{smooth_union: {fields: [" + ball + "], radius: 1, @}}")},
      {"smooth", field("{smooth_intersection: {fields: [" + ball + "], radius: 1, @}}")},
      {"smooth", field("{smooth_difference: {fields: [" + ball + "], radius: 1, @}}")},
      {"scale", field("{scale: {field: " + ball + ", factor: 2, @}}")},
      {"offset", field("{offset: {field: " + ball + ", distance: 2, @}}")},
      {"shell", field("{shell: {field: " + ball + ", thickness: 1, @}}")},
      {"cylinder",
       field("{cylinder: {center: [0, 0, 0], axis: [0, 0, 1], radius: 1, height: 1, @}}")},
      {"ellipsoid", field("{ellipsoid: {center: [0, 0, 0], radii: [1, 1, 1], @}}")},
      {"transform", field("{transform: {field: " + ball + ", translate: [0, 0, 0], @}}")},
      {"rotate",
       field("{transform: {field: " + ball + ", rotate: {axis: [0, 0, 1], degrees: 1, @}}}")},
      {"mesh", field("{mesh: {file: a.stl, @}}")},
      {"grid", field("{grid: {file: a.vdb, @}}")},
      {"mask", field("{mask: {file: a.vdb, @}}")},
      {"baked", field("{baked: {field: {sphere: {center: [0, 0, 0], radius: 1}}, @}}")},
      {"material", "materials: {m: {@}}\n"},
      {"friction", "materials: {m: {friction: {static: 1, @}}}\n"},
      {"texture", "materials: {m: {texture: {amplitude: 1, wavelength: 9, @}}}\n"},
      {"curve", "materials: {m: {curve: {stiffening: 1 N/m^2, @}}}\n"},
      {"maxwell", "materials: {m: {maxwell: {stiffness: 1 N/m, time: 1 s, @}}}\n"},
      {"lattice",
       "materials: {m: {stiffness: 1 N/m, lattice: {force: 1 mN, wavelength: [9, 9, 9], @}}}\n"},
      {"shaft", "materials: {m: {shaft: {stiffness: 1 N/m^2, in: {static: 1 N/m}, @}}}\n"},
      {"lateral",
       "materials: {m: {shaft: {stiffness: 1 N/m^2, in: {static: 1 N/m}, lateral: {stiffness: 1 "
       "N/m^2, @}}}}\n"},
      {"shaft_way", "materials: {m: {shaft: {stiffness: 1 N/m^2, in: {static: 1 N/m, @}}}}\n"},
      {"composite", "materials: {m: {composite: {radius: 1, depth: 9, @}}}\n"},
      {"map_of_grid", "materials: {m: {stiffness: {grid: {file: a.vdb}, @}}}\n"},
      {"material_grid", "materials: {m: {stiffness: {grid: {file: a.vdb, @}}}}\n"},
      {"map_of_image",
       "images: {i: {file: a.nii}}\nmaterials: {m: {stiffness: {image: i, transfer: [], @}}}\n"},
      {"image", "images: {i: {file: a.nii, @}}\n"},
      {"labels",
       "images: {i: {file: a.nii}}\nlayers: [{name: a, labels: {image: i, match: [x], @}}]\n"},
      {"threshold",
       "images: {i: {file: a.nii}}\nlayers: [{name: a, threshold: {image: i, above: 1, @}}]\n"},
      {"layer", "layers:\n  - {name: a, inside: " + ball + ", @}\n"},
      {"wall", layers + "walls:\n  - {between: [a, outside], wall: absent, @}\n"},
      {"sheet", "sheets:\n  - {name: s, on: " + ball + ", @}\n"},
      {"port", layers + "ports:\n  - {name: p, between: [a, outside], @}\n"},
      {"device", "device: {scale: 1, @}\n"},
      {"start", "start: {region: outside, @}\n"},
      {"passivity", "device: {passivity: {mass: 1 kg, @}}\n"},
      {"coupling", "device: {coupling: {stiffness: 1 N/m, @}}\n"},
      {"paper", "paper: {alpha: 1, @}\n"},
      {"force_limits", "force: {max: 1 N, @}\n"},
      {"passed_before", layers +
                            "ports:\n  - {name: q, between: [a, outside]}\n  - {name: p, between: "
                            "[a, outside], after: [{port: q, @}]}\n"},
      {"grids", layers + "grids: {tolerance: 1, @}\n"},
      {"rate", layers + "ports:\n  - {name: p, between: [a, outside], opens_at: 1 N, rate: {ratio: "
                        "2, speed: 1 mm/s, @}}\n"},
      {"hole", layers +
                   "ports:\n  - {name: p, between: [a, outside], opens_at: 1 N, hole: {radius: "
                   "1, @}}\n"},
  };
  return probes;
}

std::string withUnknownKey(const Probe& probe) {
  std::string scene = "palpate: 1\nlength: mm\n" + probe.scene;
  return scene.replace(scene.find('@'), 1, std::string(kNoKey) + ": 1");
}

TEST(Vocabulary, ReaderAndSchemaKnowTheSameKeys) {
  const SceneRegistry registry = standInReaders();
  for (const Probe& probe : probes()) {
    EXPECT_EQ(readerKeys(withUnknownKey(probe), registry), schemaKeys(probe.definition))
        << probe.definition;
  }
  EXPECT_EQ(readerKeys("palpate: 1\nlength: mm\nstart: {region: outside, " + std::string(kNoKey) +
                           ": 1}\n",
                       registry),
            testing::Words{"region"});
}

TEST(Vocabulary, EveryMapOfTheSchemaIsProbed) {
  for (const Node::Entry& definition : testing::sceneSchema().root.find("definitions")->entries) {
    if (definition.value.find("properties") == nullptr) continue;
    const bool probed = std::any_of(probes().begin(), probes().end(), [&](const Probe& probe) {
      return probe.definition == definition.key;
    });
    EXPECT_TRUE(probed) << definition.key;
    // A map that allows any key would accept every misspelled key.
    const Node* others = definition.value.find("additionalProperties");
    ASSERT_NE(others, nullptr) << definition.key;
    EXPECT_EQ(others->text, "false") << definition.key;
  }
}

// A pattern of the schema. Patterns are limited to what POSIX and ECMAScript interpret alike.
class Pattern {
 public:
  explicit Pattern(const std::string& definition) {
    const Node* map = testing::sceneSchema().root.find("definitions")->find(definition);
    const std::string& text = map->find("pattern")->text;
    EXPECT_EQ(regcomp(&regex_, text.c_str(), REG_EXTENDED | REG_NOSUB), 0) << text;
  }
  ~Pattern() { regfree(&regex_); }
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;

  [[nodiscard]] bool matches(const std::string& text) const {
    return regexec(&regex_, text.c_str(), 0, nullptr, 0) == 0;
  }

 private:
  regex_t regex_{};
};

TEST(Vocabulary, TheSchemasQuantitiesAreTheReaders) {
  const std::pair<const char*, Dimension> quantities[] = {
      {"force", Dimension::kForce},
      {"stiffness", Dimension::kStiffness},
      {"damping", Dimension::kDamping},
      {"velocity", Dimension::kVelocity},
      {"time", Dimension::kTime},
      {"stiffness_per_length", Dimension::kStiffness2},
      {"damping_per_length", Dimension::kDamping2},
      {"mass", Dimension::kMass}};
  const std::vector<std::string> numbers = {"0",  "1",   "15",  "1.5", ".5",  "5.",  "1e3",  "1E-3",
                                            "+2", "010", "00",  "1_0", "1,5", "0x1", "e3",   "1e",
                                            ".",  "",    "inf", "nan", "1 2", "--1", "1.2.3"};
  std::vector<std::string> units = {"", "x", "N.m"};
  for (const auto& [name, dimension] : quantities) {
    // Splits "N/m (also N/mm, N/cm)" into the units.
    std::string help(unitHelp(dimension));
    for (const std::string_view part : {"(also ", ",", ")"}) {
      for (std::size_t at = help.find(part); at != std::string::npos; at = help.find(part)) {
        help.erase(at, part.size());
      }
    }
    std::istringstream words(help);
    for (std::string unit; words >> unit;) units.push_back(unit);
  }
  for (const auto& [name, dimension] : quantities) {
    const Pattern pattern(name);
    for (const std::string& unit : units) {
      for (const std::string& number : numbers) {
        const std::string text = number + " " + unit;
        EXPECT_EQ(pattern.matches(text),
                  parseQuantity(text, dimension).status == Quantity::Status::kOk)
            << name << " '" << text << "'";
      }
    }
  }
}

TEST(Vocabulary, TheSchemasNamesAreTheReaders) {
  const Pattern pattern("name");
  for (const std::string name : {"a", "3rd ventricle (left)", "Thalamus_L", "a.b-c", "a b", " a",
                                 "a ", "a*", "a?", "a,b", "a;b", "a/b", "a\"b", "a\\b", ""}) {
    const auto accepted = [&] {
      std::string escaped;
      for (const char c : name)
        escaped += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
      try {
        (void)parseScene("palpate: 1\nlength: mm\nlayers: [{name: \"" + escaped +
                             "\", inside: {sphere: {center: [0, 0, 0], radius: 1}}}]\n",
                         "test.yaml");
        return true;
      } catch (const Error&) {
        return false;
      }
    };
    EXPECT_EQ(pattern.matches(name), accepted()) << name;
  }
}

std::string referencePage() {
  std::ifstream file(test::sourceFolder() + "/tools/docs/scene.md");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Vocabulary, TheReferenceNamesEveryKeyAndUnit) {
  const std::string page = referencePage();
  ASSERT_FALSE(page.empty());
  for (const std::string& key : allSchemaKeys()) {
    EXPECT_NE(page.find("`" + key + "`"), std::string::npos) << key;
  }
  for (const Dimension dimension :
       {Dimension::kLength, Dimension::kForce, Dimension::kStiffness, Dimension::kDamping,
        Dimension::kVelocity, Dimension::kTime, Dimension::kStiffness2, Dimension::kDamping2,
        Dimension::kMass}) {
    EXPECT_NE(page.find(unitHelp(dimension)), std::string::npos) << unitHelp(dimension);
  }
}

// The page's examples add up to one scene; blocks that begin with `palpate:` are complete scenes.
TEST(Vocabulary, TheReferencesExamplesAreRead) {
  const SceneRegistry registry = standInReaders();
  const std::string page = referencePage();
  const std::string open = "\n```yaml\n";
  std::string together = "palpate: 1\nlength: mm\n";
  int examples = 0;
  for (std::size_t at = page.find(open); at != std::string::npos; at = page.find(open, at + 1)) {
    const std::size_t start = at + open.size();
    const std::string block = page.substr(start, page.find("```\n", start) - start);
    ++examples;
    if (block.rfind("palpate:", 0) == 0) {
      EXPECT_NO_THROW((void)parseScene(block, "example", registry)) << block;
    } else {
      together += block;
    }
  }
  EXPECT_GT(examples, 5);
  EXPECT_NO_THROW((void)parseScene(together, "examples", registry)) << together;
}

}  // namespace
}  // namespace palpate
