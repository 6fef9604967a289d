#include "job.hpp"

#include <exception>
#include <iostream>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/petsc/session.hpp"

namespace samara::drivers {
namespace {

std::string libraries_in_a_line() {
  std::string text = petsc::library_versions() + "\n" + io::file_library_version();
  for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i))
    text.replace(i, 1, "; ");
  return text;
}

void write_files(const Job& job, const std::function<void(io::ResultFile&)>& write_result,
                 const std::function<void(const std::string&)>& write_csv) {
  if (!job.result_path.empty()) {
    io::ResultFile file(job.result_path, job.input, record_of(job));
    write_result(file);
    file.publish();
  }
  if (!job.csv_path.empty()) write_csv(job.csv_path);
}

}  // namespace

io::RunRecord record_of(const Job& job) {
  return {job.command_line, petsc::Session::options(), libraries_in_a_line(),
          petsc::Session::size()};
}

void deliver(const Job& job, const std::string& tables,
             const std::function<void(io::ResultFile&)>& write_result,
             const std::function<void(const std::string&)>& write_csv) {
  std::exception_ptr failure;
  try {
    write_files(job, write_result, write_csv);
  } catch (...) {
    failure = std::current_exception();
  }
  std::cout << tables;
  if (!failure && !job.result_path.empty()) std::cout << "result: " << job.result_path << "\n";
  if (!failure && !job.csv_path.empty()) std::cout << "table: " << job.csv_path << "\n";
  std::cout << std::flush;
  if (failure) std::rethrow_exception(failure);
}

void require_other_path(const std::string& path, const std::vector<std::string>& sources) {
  for (const std::string& source : sources)
    if (io::is_same_file(path, source))
      throw InputError(path + ": is read by this run; hint: give the output another name with -o");
}

}  // namespace samara::drivers
