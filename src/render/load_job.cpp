// Loads render descriptions as jobs.

#include "etendue/render/job.h"
#include "language/loader.h"
#include "render/import_job.h"

namespace etendue {

Ref<Job> load_job(const std::string& path, const LoadOptions& options) {
  try {
    if (const Ref<Importer> importer = importer_of(path)) {
      const ImportedJob imported = import_job(*importer, path, options);
      for (const Error& note : imported.notes) warn(note.what(), note.location);
      return imported.job;
    }
    language::Loader loader(options, &imported_files());
    loader.add_file(path);
    return ref_cast<Job>(loader.result(true));
  } catch (const std::bad_alloc&) {
    throw Error("there is not enough memory for what it describes", {intern(path), 0, 0});
  }
}

Ref<Job> load_job_text(const std::string& text, const std::string& name, const std::string& folder,
                       const LoadOptions& options) {
  language::Loader loader(options, &imported_files());
  loader.add_text(text, name, folder);
  return ref_cast<Job>(loader.result(true));
}

}  // namespace etendue
