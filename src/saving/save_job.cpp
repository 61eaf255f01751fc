#include "save_job.h"

#include <fmt/format.h>

#include <filesystem>

#include "components/scenes/import.h"
#include "etendue/exporter.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "files/whole_file.h"
#include "language/json.h"
#include "render/checkpoint.h"

namespace etendue {

namespace {

/// Throws Error for a file whose name says that it is something else than a description.
void require_description_name(const std::string& file, Location at) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending.empty() || ending == ".etd" || language::is_json(file)) return;
  throw Error(fmt::format("'{}': the name of a description ends in .etd or .json{}", file,
                          exporter_of(file) ? fmt::format("; 'etendue export' writes {}", ending) : std::string()),
              at);
}

}  // namespace

void save_description(const Job& job, const std::string& file, const std::string& comments, bool all, Location at) {
  note_inputs_of(job);
  OutputFiles files;
  files.add(file, at);
  files.raise();
  require_description_name(file, at);
  std::error_code error;
  const std::string folder = std::filesystem::absolute(file, error).parent_path().string();
  if (error) throw Error(fmt::format("cannot write '{}': {}", file, error.message()), at);
  write_whole_file(file,
                   language::is_json(file) ? write_json(job, all, folder) : comments + write_description(job, all, folder));
}

void require_exporter(const std::string& file, Location at) {
  if (exporter_of(file)) return;
  std::string known;
  for (const std::string& ending : exported_extensions()) known += (known.empty() ? "." : ", .") + ending;
  throw Error(fmt::format("no exporter for files named like '{}'; there are those for {}", file, known), at);
}

void export_job(const Job& job, const std::string& file, bool strict, Location at) {
  require_exporter(file, at);
  note_inputs_of(job);
  read_imports(job);
  OutputFiles files;
  files.add(file, at);
  files.raise();
  Exporting exporting(file);
  const std::string text = exporter_of(file)->write(job, exporting);
  const std::vector<Error> notes = exporting.notes();
  if (strict && !notes.empty()) throw Errors(notes);
  for (const Error& note : notes) warn(note.what(), note.location);
  // The files that the exported file refers to are written first, so that it never exists without them.
  for (const std::string& beside : exporting.files_beside()) files.add(beside, at);
  files.raise();
  exporting.write_files();
  write_whole_file(file, text);
}

}  // namespace etendue
