// Drives a render from a program: reads its state while it runs, edits it, saves its state and writes its images.
#include <cstdio>
#include <fstream>
#include <future>

#include "etendue/language/language.h"
#include "etendue/render/render.h"

using namespace etendue;

int drive(const std::string& file, const std::string& folder) {
  const Ref<Job> job = load_job(file);
  Render render(job, {.on_progress = [](const Progress& p) { std::printf("%3.0f %%\n", 100 * p.fraction); }});
  std::future<Ended> running = std::async(std::launch::async, [&] { return render.run(); });

  // From any other thread, at any time: a copy of the current image, as a display would show it.
  const RenderSnapshot now = render.snapshot();
  const Image shown = render.display(now.picture());
  std::printf("%d x %d pixels after %.1f s\n", shown.width, shown.height, now.progress.seconds);

  // Another exposure keeps all samples; another colour starts over with the scene unchanged; of shapes only the edited one is
  // rebuilt.
  render.edit(*job->tone_map, "stops", parse_value("1"));
  render.edit(*job->camera, "fov", parse_value("35 deg"));
  try {
    render.edit(*job->camera, "fov", parse_value("-1 deg"));
  } catch (const Error& error) {  // the job is unchanged
    std::printf("refused: %s\n", error.what());
  }

  running.get();  // throws the render's error, if there was one
  render.run();   // if the last edit came after the end: continues, or returns at once
  render.save(folder + "/state");

  // Another process loads the state and continues. So could another machine, which renders other steps that are merged here.
  Render other(load_job(file));
  for (const char* member : {"tone_map", "camera"}) other.edit(other.job(), member, get(*job, member));
  other.load(folder + "/state");
  std::printf("%u samples per pixel\n", other.progress().samples);
  for (const std::string& path : other.write_outputs(folder + "/picture")) std::printf("%s\n", path.c_str());
  return 0;
}

int main(int count, char** arguments) {
  try {
    return count == 3 ? drive(arguments[1], arguments[2]) : 2;
  } catch (const Errors& errors) {
    for (const Error& error : errors.errors) std::fprintf(stderr, "%s\n", show(error).c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", show(error).c_str());
  }
  return 1;
}
