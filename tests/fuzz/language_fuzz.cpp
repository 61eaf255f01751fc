// Arbitrary bytes as a render description: they load or are rejected with Errors, without any other failure. A description that
// loads is written and reads back as an equal job.

#include <cstdio>
#include <cstdlib>

#include "etendue/language/language.h"
#include "etendue/render/job.h"

namespace {

[[noreturn]] void stop(const char* why, const std::string& text) {
  std::fprintf(stderr, "%s:\n%s\n", why, text.c_str());
  std::abort();
}

void check(const etendue::Error& error, const std::string& text) {
  if (!error.location.known()) stop("an error without a place", text);
  if (etendue::show(error).empty()) stop("an error without words", text);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace etendue;
  const std::string text(reinterpret_cast<const char*>(data), size);
  LoadOptions options;
  options.allow_files = false;  // the texts have no folder: they must open no file
  try {
    const Ref<Job> job = load_job_text(text, "fuzz", {}, options);
    if (!job) stop("neither a job nor an error", text);
    const std::string written = write_description(*job);
    const Ref<Job> again = load_job_text(written, "written", {}, options);
    if (!equal(Value(Ref<Component>(job)), Value(Ref<Component>(again))))
      stop("does not read back as it was", text + "\n---\n" + written);
  } catch (const Errors& e) {
    if (e.errors.empty()) stop("no errors in Errors", text);
    for (const Error& error : e.errors) check(error, text);
  } catch (const Error& e) {
    check(e, text);
  }
  return 0;
}
