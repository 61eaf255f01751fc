// Drives a render from a program of one's own: looks at it, edits it while it goes on, keeps its state, writes its pictures.
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

  // From any other thread, at any time: what there is, as a display would show it.
  const RenderSnapshot now = render.snapshot();
  const Image shown = render.display(now.picture());
  std::printf("%d x %d pixels after %.1f s\n", shown.width, shown.height, now.progress.seconds);

  // Another exposure loses nothing; another colour begins anew, with the scene as it is; a shape is built anew, alone.
  render.edit(*job->tone_map, "stops", parse_value("1"));
  render.edit(*job->camera, "fov", parse_value("35 deg"));
  try {
    render.edit(*job->camera, "fov", parse_value("-1 deg"));
  } catch (const Error& error) {  // and nothing has changed
    std::printf("refused: %s\n", error.what());
  }

  running.get();  // throws what went wrong, if anything did
  render.run();   // if the last edit came after its end: goes on, or returns at once
  render.save(folder + "/state");

  // Another process takes the state over. So might another machine, which renders other steps that are added here.
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
