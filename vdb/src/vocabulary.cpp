#include "palpate/scene/vocabulary.h"

#include "own_vocabulary.h"
#include "palpate/vdb/register.h"

namespace palpate::vdb {

VocabularyPtr vocabulary(const Vocabulary& of) {
  auto all = std::make_shared<Vocabulary>(of);
  all->add(kOwnVocabulary, "vocabulary.yaml");
  return all;
}

}  // namespace palpate::vdb
