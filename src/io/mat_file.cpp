#include "samara/io/mat_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::io {
namespace {

constexpr char header_text[] = "MATLAB 5.0 MAT-file, linear models of samara";
constexpr std::size_t header_size = 116;

// Types of data elements and classes of arrays.
constexpr std::uint32_t mi_int8 = 1;
constexpr std::uint32_t mi_uint16 = 4;
constexpr std::uint32_t mi_int32 = 5;
constexpr std::uint32_t mi_uint32 = 6;
constexpr std::uint32_t mi_double = 9;
constexpr std::uint32_t mi_matrix = 14;
constexpr std::uint32_t mx_char = 4;
constexpr std::uint32_t mx_double = 6;

using Bytes = std::vector<char>;

template <class Value>
void append(Bytes& bytes, const Value* values, std::size_t count) {
  const std::size_t at = bytes.size();
  bytes.resize(at + count * sizeof(Value));
  if (count > 0) std::memcpy(bytes.data() + at, values, count * sizeof(Value));
}

/// A data element: type, size, data padded to eight bytes.
template <class Value>
void append_element(Bytes& bytes, std::uint32_t type, const std::vector<Value>& values) {
  const std::array<std::uint32_t, 2> tag{type,
                                         static_cast<std::uint32_t>(values.size() * sizeof(Value))};
  append(bytes, tag.data(), tag.size());
  append(bytes, values.data(), values.size());
  while (bytes.size() % 8 != 0) bytes.push_back(0);
}

class Writer {
 public:
  Writer() {
    bytes_.assign(header_size, ' ');
    std::copy(header_text, header_text + sizeof(header_text) - 1, bytes_.begin());
    bytes_.resize(header_size + 8, 0);  // no subsystem data
    const std::array<std::uint16_t, 2> version{0x0100,
                                               0x4d49};  // "MI" in the byte order of this machine
    append(bytes_, version.data(), version.size());
  }

  /// Column-major values.
  void add(const std::string& name, const std::vector<std::int32_t>& sizes,
           const std::vector<double>& values) {
    add_array(name, mx_double, sizes,
              [&values](Bytes& bytes) { append_element(bytes, mi_double, values); });
  }

  /// One row per text.
  void add(const std::string& name, const std::vector<std::string>& texts) {
    std::size_t width = 1;
    for (const std::string& text : texts) width = std::max(width, text.size());
    std::vector<std::uint16_t> letters;
    for (std::size_t column = 0; column < width; ++column)
      for (const std::string& text : texts)
        letters.push_back(column < text.size() ? static_cast<unsigned char>(text[column]) : ' ');
    add_array(name, mx_char,
              {static_cast<std::int32_t>(texts.size()), static_cast<std::int32_t>(width)},
              [&letters](Bytes& bytes) { append_element(bytes, mi_uint16, letters); });
  }

  const Bytes& bytes() const { return bytes_; }

 private:
  void add_array(const std::string& name, std::uint32_t array_class,
                 const std::vector<std::int32_t>& sizes,
                 const std::function<void(Bytes&)>& add_values) {
    Bytes content;
    append_element(content, mi_uint32, std::vector<std::uint32_t>{array_class, 0});
    append_element(content, mi_int32, sizes);
    append_element(content, mi_int8, std::vector<char>(name.begin(), name.end()));
    add_values(content);
    append_element(bytes_, mi_matrix, content);
  }

  Bytes bytes_;
};

std::vector<std::string> names_of(const std::vector<system::Signal>& signals) {
  std::vector<std::string> texts;
  for (const system::Signal& signal : signals)
    texts.push_back(signal.name + " [" + signal.unit + "]");
  return texts;
}

void add_form(Writer& writer, const linear::NamedForm& form) {
  for (const auto& [letter, matrix, row, column] : linear::state_space_parts) {
    std::vector<double> values;
    for (const linear::StateSpace& coefficient : form.series.coefficients()) {
      const Eigen::MatrixXd& part = coefficient.*matrix;
      values.insert(values.end(), part.data(), part.data() + part.size());
    }
    const Eigen::MatrixXd& first = form.series.mean().*matrix;
    std::vector<std::int32_t> sizes{static_cast<std::int32_t>(first.rows()),
                                    static_cast<std::int32_t>(first.cols())};
    if (form.series.harmonics() > 0)
      sizes.push_back(static_cast<std::int32_t>(form.series.coefficients().size()));
    writer.add(form.name + "_" + letter, sizes, values);
  }
  std::vector<std::string> states;
  std::vector<double> scales;
  for (const linear::ModelState& state : form.states) {
    states.push_back(state.name + " [" + state.unit + "]");
    scales.push_back(state.scale);
  }
  writer.add(form.name + "_states", states);
  writer.add(form.name + "_scale", {static_cast<std::int32_t>(scales.size()), 1}, scales);
  writer.add(form.name + "_inputs", names_of(form.inputs));
  writer.add(form.name + "_outputs", names_of(form.outputs));
}

}  // namespace

void write_mat_file(const std::string& path, const linear::Linearization& linearization) {
  Writer writer;
  writer.add("rotor_speed", {1, 1}, std::vector<double>{linearization.rotor_speed});
  for (const linear::NamedForm& form : linearization.forms) add_form(writer, form);
  write_whole_file(path, writer.bytes());
}

void require_mat_path(const std::string& path) {
  if (!require_writable(path)) return;
  std::string start(sizeof(header_text) - 1, ' ');
  std::ifstream stream(path, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start != header_text)
    throw InputError(path +
                     ": exists and is no MAT-file of samara, it would be lost; hint: linearize.mat "
                     "gives it another name");
}

}  // namespace samara::io
