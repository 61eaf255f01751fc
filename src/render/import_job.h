#pragma once
// Files of other programs into jobs.

#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "language/loader.h"

namespace etendue {

struct ImportedJob {
  Ref<Job> job;
  std::vector<Error> notes;  ///< what is not as in the source, or was added for it
};

/// The job that a file of another program describes. To one that holds objects alone a camera that sees them all and a sky are
/// added. Throws Errors; of the notes too when the options are strict.
ImportedJob import_job(const Importer&, const std::string& path, const LoadOptions&);

/// How files of other programs are included in descriptions.
const language::OtherFiles& imported_files();

}  // namespace etendue
