// palpate import: the tissue that a label's name or code means.

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "import/tissue_names.h"
#include "import/tissue_table.h"
#include "palpate/vdb/label_codes.h"
#include "support/scan_folder.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

using tools::NameVerdict;
using tools::TissueClass;
using tools::TissueNames;
using Expected = std::vector<std::pair<const char*, const char*>>;

/// Each name is judged in the company of all others.
void expectTissues(const Expected& expected) {
  std::vector<std::string> names;
  for (const auto& [name, tissue] : expected) names.emplace_back(name);
  const std::vector<NameVerdict> verdicts = TissueNames::own().of(names);
  for (std::size_t n = 0; n < names.size(); ++n) {
    EXPECT_EQ(verdicts[n].tissue, expected[n].second) << names[n] << ": " << verdicts[n].why;
  }
}

TEST(ImportNames, AreCutIntoWords) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(tools::wordsOf("ParaHippocampal_L2"), (Words{"para", "hippocampal", "l", "2"}));
  EXPECT_EQ(tools::wordsOf("3rd-Ventricle"), (Words{"third", "ventricle"}));
  EXPECT_EQ(tools::wordsOf("rib1"), (Words{"rib", "1"}));
  EXPECT_EQ(tools::wordsOf("Fornix (column and body)"), (Words{"fornix"}));
  EXPECT_EQ(tools::wordsOf("M. psoas major"), (Words{"m.", "psoas", "major"}));
  EXPECT_EQ(tools::wordsOf("(12)"), (Words{"12"}));
  EXPECT_TRUE(tools::wordsOf("").empty());
}

TEST(ImportNames, TheNounDecidesNotTheOrderOfAList) {
  expectTissues({{"fat body of the knee", "fat"},
                 {"infrapatellar_fat_body", "fat"},
                 {"patellar cartilage", "cartilage"},
                 {"patellar ligament", "tendon"},
                 {"patella", "bone"},
                 {"thyroid cartilage", "cartilage"},
                 {"thyroid_gland", "soft_tissue"},
                 {"mandible", "bone"},
                 {"submandibular_gland_left", "soft_tissue"},
                 {"femoral artery", "vessel"},
                 {"femoral nerve", "nerve"},
                 {"femoral vein", "vein"},
                 {"femur", "bone"},
                 {"biceps_femoris_left", "muscle"},
                 {"temporal bone", "bone"},
                 {"temporalis", "muscle"},
                 {"superficial temporal artery", "vessel"},
                 {"mastoid air cells", "air"},
                 {"air cells of the mastoid", "air"},
                 {"mastoid process", "bone"},
                 {"sternocleidomastoid", "muscle"},
                 {"sagittal sinus", "vein"},
                 {"maxillary sinus", "airway"},
                 {"aortic sinus", "vessel"},
                 {"renal pelvis", "fluid"},
                 {"pelvis", "bone"},
                 {"atlas", "bone"},
                 {"vertebral artery", "vessel"},
                 {"vertebrae_L3", "bone"},
                 {"vertebral canal", "csf"},
                 {"intervertebral disc L3-L4", "disc"},
                 {"spinal cord", "nerve"},
                 {"levator_scapulae_left", "muscle"},
                 {"scapula", "bone"},
                 {"arch of aorta", "vessel"},
                 {"zygomatic arch", "bone"},
                 {"costal cartilages", "cartilage"},
                 {"flexor carpi radialis", "muscle"},
                 {"thoracic aorta", "vessel"},
                 {"aorta_thoracic", "vessel"},
                 {"esophagus_cervical", "hollow_organ"},
                 {"thoracic4", "bone"},
                 {"Outer-Table", "bone"},
                 {"Inner Table", "bone"},
                 {"diploe", "bone"},
                 {"hip_implant", "implant"},
                 {"kidney_cyst_left", "fluid"},
                 {"liver_vessels", "vessel"},
                 {"aorta_false_lumen", "vessel"},
                 {"portal_vein_and_splenic_vein", "vein"},
                 {"heart_ventricle_left", "blood"},
                 {"heart_myocardium", "muscle"},
                 {"eye_lens_left", "soft_tissue"},
                 {"eyeball", "eye"},
                 {"vitreous humor", "vitreous"}});
}

TEST(ImportNames, AreReadInLatin) {
  expectTissues({{"musculus gluteus maximus", "muscle"},
                 {"M. biceps femoris", "muscle"},
                 {"tendo musculi bicipitis", "tendon"},
                 {"os temporale", "bone"},
                 {"arteria carotis interna", "vessel"},
                 {"A. femoralis", "vessel"},
                 {"vena cava inferior", "vein"},
                 {"nervus ischiadicus", "nerve"},
                 {"ligamentum patellae", "tendon"},
                 {"cartilago thyroidea", "cartilage"},
                 {"medulla oblongata", "brain"},
                 {"medulla spinalis", "nerve"},
                 {"ventriculus quartus", "ventricle"},
                 {"aqueductus cerebri", "ventricle"},
                 {"dura mater", "dura"},
                 {"corpus callosum", "brain"},
                 {"caput femoris", "bone"},
                 {"vesica fellea", ""}});
}

TEST(ImportNames, MeanOtherThingsInOtherCompany) {
  // All other names are of the brain, as in AAL.
  expectTissues({{"Precentral_L", "brain"},
                 {"Frontal_Sup_Orb_R", "brain"},
                 {"Rectus_L", "brain"},
                 {"Angular_L", "brain"},
                 {"Temporal_Mid_R", "brain"},
                 {"Insula_L", "brain"},
                 {"Thalamus_R", "brain"},
                 {"gyrus rectus", "brain"},
                 {"Putamen_L", "brain"}});
  // Here no other name is of the brain.
  expectTissues({{"Rectus_L", "muscle"}, {"rectus_femoris", "muscle"}, {"femur", "bone"}});
  expectTissues({{"angular", ""}, {"femur", "bone"}});
  expectTissues({{"medial rectus", "muscle"},
                 {"left_temporalis", "muscle"},
                 {"frontalis", "muscle"},
                 {"thalamus", "brain"},
                 {"insula", "brain"},
                 {"putamen", "brain"},
                 {"uncus", "brain"}});
  expectTissues({{"left ventricle", "blood"}, {"left atrium", "blood"}, {"aorta", "vessel"}});
  expectTissues({{"left ventricle", "ventricle"}, {"putamen", "brain"}, {"insula", "brain"}});
}

TEST(ImportNames, ThatSayTwoThingsOrNothingFitNothing) {
  expectTissues({{"BoneOrAir", ""},
                 {"abdomen and pelvis", ""},
                 {"label_7", ""},
                 {"Segment_1", ""},
                 {"hip joint", ""},
                 {"", ""},
                 {"17", ""},
                 {"left", ""},
                 {"undetermined", ""}});
}

TEST(ImportNames, LikeThoseOfFreeSurferAndSynthSeg) {
  expectTissues({{"Left-Cerebral-White-Matter", "brain"},
                 {"Left-Cerebral-Cortex", "brain"},
                 {"Left-Lateral-Ventricle", "ventricle"},
                 {"Right-Inf-Lat-Vent", "ventricle"},
                 {"3rd-Ventricle", "ventricle"},
                 {"4th-Ventricle", "ventricle"},
                 {"CSF", "csf"},
                 {"Left-VentralDC", "brain"},
                 {"Left-choroid-plexus", "brain"},
                 {"Optic-Chiasm", "nerve"},
                 {"WM-hypointensities", "brain"},
                 {"ctx-lh-superiortemporal", "brain"},
                 {"ctx_rh_S_temporal_sup", "brain"},
                 {"wm-lh-insula", "brain"},
                 {"Brain-Stem", "brain"},
                 {"Cbm_Right_FLOs", "brain"},
                 {"Left-vessel", "vessel"},
                 {"Skull", "bone"},
                 {"Air", "air"},
                 {"Left-Common-IliacV", "vein"}});
  const TissueNames& names = TissueNames::own();
  for (const auto& [number, tissue] : std::map<int, std::string>{{2, "brain"},
                                                                 {4, "ventricle"},
                                                                 {24, "csf"},
                                                                 {43, "ventricle"},
                                                                 {1035, "brain"},
                                                                 {165, "bone"}}) {
    EXPECT_EQ(names.ofNumber("freesurfer", number), tissue) << number;
  }
  EXPECT_FALSE(names.ofNumber("freesurfer", 29).has_value());
  EXPECT_FALSE(names.ofNumber("nobody", 2).has_value());
}

TEST(ImportNames, EveryTissueThatTheyMeanIsInTheTable) {
  const tools::TissueTable table = tools::ownTissueTable();
  for (const std::string& tissue : TissueNames::own().tissues()) {
    EXPECT_NE(table.find(tissue), nullptr) << tissue;
  }
}

TEST(ImportNames, CodesOfSlicerDecideBeforeWords) {
  const TempFolder folder;
  const auto segment = [](int n, const std::string& name, const std::string& code) {
    const std::string key = "Segment" + std::to_string(n) + "_";
    return key + "Name:=" + name + "\n" + key + "LabelValue:=" + std::to_string(n + 1) + "\n" +
           key + "Layer:=0\n" + key + "Tags:=Segmentation.Status:inprogress|TerminologyEntry:List" +
           "~SCT^123037004^Anatomical Structure~SCT^" + code + "~^^~Anatomic codes~^^~^^|\n";
  };
  std::string bytes =
      "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: right-anterior-superior\nsizes: 9 3 3\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nkinds: domain domain domain\nencoding: raw\n"
      "space origin: (0,0,0)\n" +
      segment(0, "Segment_1", "272673000^Bone") + segment(1, "Schädel", "89546000^Skull") +
      segment(2, "soft thing", "85756007^Tissue") + segment(3, "muscle", "85756007^Tissue") +
      segment(4, "vein", "51114001^Artery") + segment(5, "Segment_6", "181268008^Ear ossicle") +
      "\n";
  for (int slice = 0; slice < 9; ++slice) {
    for (char i = 0; i < 9; ++i) bytes += i < 6 ? static_cast<char>(i + 1) : '\0';
  }
  (void)folder.file("s.seg.nrrd", bytes);
  const vdb::LabelCodes codes = vdb::readLabelCodes(folder.path("s.seg.nrrd"));
  ASSERT_EQ(codes.size(), 6U);
  EXPECT_EQ(codes.at(2).scheme, "SCT");
  EXPECT_EQ(codes.at(2).value, "89546000");
  EXPECT_EQ(codes.at(2).meaning, "Skull");
  const CommandResult result =
      runPalpate({"import", "s.seg.nrrd", "--dry-run", "--json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::map<std::string, std::string> tissue;
  const Json json = parseOnly(result);
  for (const Json& label : json["labels"]) tissue[label["name"]] = label["tissue"];
  EXPECT_EQ(tissue, (std::map<std::string, std::string>{{"Segment_1", "bone"},
                                                        {"Schädel", "bone"},
                                                        {"soft thing", "soft_tissue"},
                                                        {"muscle", "muscle"},
                                                        {"vein", "vessel"},
                                                        {"Segment_6", "bone"}}));
  ASSERT_EQ(json["unmatched"].size(), 1U);
  EXPECT_EQ(json["unmatched"][0]["name"], "soft thing");
  // The report notes a name that disagrees with its code.
  EXPECT_NE(result.err.find("the code decides"), std::string::npos) << result.err;
}

/// Names of a table: `index name` or `value,name`; label 0 left out.
std::vector<std::string> namesIn(const std::string& path) {
  std::vector<std::string> names;
  for (const auto& [label, name] : vdb::readLabelTable(path).names) {
    if (label != 0) names.push_back(name);
  }
  return names;
}

std::set<std::string> tissuesOf(const std::vector<std::string>& names, std::size_t& unmatched) {
  std::set<std::string> met;
  unmatched = 0;
  const std::vector<NameVerdict> verdicts = TissueNames::own().of(names);
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (verdicts[n].tissue.empty()) {
      ++unmatched;
      std::printf("  nothing fits %s: %s\n", names[n].c_str(), verdicts[n].why.c_str());
    } else {
      met.insert(verdicts[n].tissue);
    }
  }
  return met;
}

TEST(ImportNames, OfAalAreAllBrain) {
  const std::string path = "/usr/share/mricron/templates/aal.nii.txt";
  ASSERT_TRUE(std::filesystem::exists(path))
      << "of Debian's mricron-data, which tools/setup.sh installs";
  std::size_t unmatched = 0;
  const std::vector<std::string> names = namesIn(path);
  ASSERT_EQ(names.size(), 116U);
  EXPECT_EQ(tissuesOf(names, unmatched), std::set<std::string>{"brain"});
  EXPECT_EQ(unmatched, 0U);
}

TEST(ImportNames, OfTheScansAreAllKnown) {
  PALPATE_NEEDS_SCAN(scanPath("abdomen/labels.csv"));
  const tools::TissueTable table = tools::ownTissueTable();
  for (const char* file : {"abdomen/labels.csv", "pelvis/labels.csv", "head_neck/colors.ctbl"}) {
    const std::vector<std::string> names = namesIn(scanPath(file));
    std::size_t unmatched = 0;
    (void)tissuesOf(names, unmatched);
    EXPECT_EQ(unmatched, 0U) << file;
    // From the words in the names, none of which decides by the dictionary of whole names.
    const std::vector<NameVerdict> verdicts = TissueNames::own().of(names);
    for (std::size_t n = 0; n < names.size(); ++n) {
      const auto says = [&](const char* word) { return names[n].find(word) != std::string::npos; };
      const TissueClass kind = table.find(verdicts[n].tissue)->kind;
      if (says("muscle") || says("gluteus") || says("psoas") || says("gland")) {
        EXPECT_EQ(kind, TissueClass::kSolid) << names[n];
      } else if (says("artery") || says("vein") || says("vena") || says("carotid") ||
                 says("aorta")) {
        EXPECT_EQ(kind, TissueClass::kMembrane) << names[n];
      } else if (says("rib") || says("vertebra") || says("femur") || says("cartilage")) {
        EXPECT_EQ(kind, TissueClass::kRigid) << names[n];
      }
    }
  }
}

}  // namespace
}  // namespace palpate::testing
