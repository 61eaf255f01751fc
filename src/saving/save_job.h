#pragma once
// Writes a job to a file: as a description of our own, or as a scene of another program.

#include <string>

#include "etendue/render/job.h"

namespace etendue {

/// Writes a job as a description, .etd or JSON by the file's name, after the `comments`. `all` writes every member. The file is
/// written whole or not at all; inputs of the job are not overwritten. Throws Error with `at`, where the file's name was given,
/// also for a name of another ending than those two.
void save_description(const Job&, const std::string& file, const std::string& comments, bool all, Location at);

/// Throws Error with `at` if no exporter writes files named like this.
void require_exporter(const std::string& file, Location at);

/// Writes a job as a scene file of another program, by the file's name, with the files that it refers to beside it. The job was
/// read, but not prepared. Warns of what the other program cannot express, or with `strict` throws it as Errors. Throws Error
/// with `at` if no exporter writes such files, or a file cannot be written.
void export_job(const Job&, const std::string& file, bool strict, Location at);

}  // namespace etendue
