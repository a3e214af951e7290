// frames.journal of an unfinished sequence, and a file of baked light: the program's own files, damaged.
#include "sim/sequence/journal.h"

#include "sim/light/cache.h"
#include "tests/fuzz/hold.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile journal(sim::kJournalName), light("world.light");
  for (fuzz::InputFile* file : {&journal, &light}) file->Write({data, size});
  fuzz::Hold(journal.path().string(), [] { sim::ReadJournal(fuzz::Folder()); });
  fuzz::Hold(light.path().string(), [] { sim::ReadLight(light.path(), {1, 2}); });
  return 0;
}
