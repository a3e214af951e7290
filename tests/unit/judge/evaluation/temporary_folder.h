// Temporary folder, by the name that the judge's tests use.
#pragma once

#include "tests/temporary_folder.h"

namespace evaluation {

using vobench_test::TemporaryFolder;

}  // namespace evaluation
