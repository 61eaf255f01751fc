#pragma once
// Import of files of other programs as jobs.

#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "language/loader.h"

namespace etendue {

struct ImportedJob {
  Ref<Job> job;
  std::vector<Error> notes;  ///< differences from the source file, and additions to it
};

/// The job that a file of another program describes. If the file contains objects only, a camera that sees them all and an
/// environment light are added. Throws Errors; with strict options also for the notes.
ImportedJob import_job(const Importer&, const std::string& path, const LoadOptions&);

/// The interface by which descriptions include files of other programs.
const language::OtherFiles& imported_files();

}  // namespace etendue
