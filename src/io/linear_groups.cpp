#include "linear_groups.hpp"

#include <functional>

#include "axes.hpp"

namespace samara::io {
namespace {

using linear::NamedForm;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr char signal_frame[] = "frames of the states, inputs and outputs";

std::vector<double> row_major(const Eigen::MatrixXd& matrix) {
  const Matrix rows = matrix;
  return {rows.data(), rows.data() + rows.size()};
}

/// Writes matrices of the same size one after the other. A single one is written as [row, column]:
/// the first of the axes in `meaning` is left out.
void write_stack(Hdf5File& file, const std::string& name, std::size_t count,
                 const std::function<Eigen::MatrixXd(std::size_t)>& item, bool is_single,
                 Meaning meaning) {
  std::vector<double> values;
  Hdf5File::Shape shape;
  if (is_single)
    meaning.axes.erase(meaning.axes.begin());
  else
    shape.push_back(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::MatrixXd matrix = item(i);
    const std::vector<double> rows = row_major(matrix);
    values.insert(values.end(), rows.begin(), rows.end());
    if (i > 0) continue;
    shape.push_back(static_cast<hsize_t>(matrix.rows()));
    shape.push_back(static_cast<hsize_t>(matrix.cols()));
  }
  file.write(name, values, shape, meaning);
}

/// `axis` is the name of one of the signals ("input"), `what` that of all of them ("inputs").
void write_signals(Hdf5File& file, const std::string& group, const std::string& axis,
                   const std::string& what, const std::vector<system::Signal>& signals) {
  std::vector<std::string> names, units, frames, descriptions;
  for (const system::Signal& signal : signals) {
    names.push_back(signal.name);
    units.push_back(signal.unit);
    frames.push_back(signal.frame);
    descriptions.push_back(signal.description);
  }
  const std::string place = group + "/" + what;
  file.write(place + "/name", names, {"", "none", "names of the " + what, {axis}});
  file.write(place + "/unit", units, {"", "none", "units of the " + what, {axis}});
  file.write(place + "/frame", frames, {"", "none", "frames of the " + what, {axis}});
  file.write(place + "/description", descriptions, {"", "none", what + " in words", {axis}});
}

std::string part_description(const linear::StateSpacePart& part) {
  return std::string("matrix ") + part.name + " of the form";
}

void write_form(Hdf5File& file, const NamedForm& form) {
  const std::string group = "/linearize/" + form.name;
  const auto& coefficients = form.series.coefficients();
  const bool is_single = coefficients.size() == 1;
  if (!is_single)
    file.write(group + "/coefficient", harmonic_names(form.series.harmonics()),
               {"", "none", "coefficients of the Fourier series in the azimuth", {"coefficient"}});
  for (const linear::StateSpacePart& part : linear::state_space_parts)
    write_stack(file, group + "/" + part.name, coefficients.size(),
                [&](std::size_t i) { return coefficients[i].*(part.matrix); }, is_single,
                {"SI, outputs in their units",
                 signal_frame,
                 part_description(part),
                 {"coefficient", part.row, part.column}});
  if (!form.at_azimuths.empty())
    for (const linear::StateSpacePart& part : linear::state_space_parts)
      write_stack(file, group + "/at_azimuths/" + part.name, form.at_azimuths.size(),
                  [&](std::size_t i) { return form.at_azimuths[i].*(part.matrix); }, false,
                  {"SI, outputs in their units",
                   signal_frame,
                   part_description(part),
                   {"azimuth", part.row, part.column}});
  std::vector<std::string> names, units;
  std::vector<double> scales;
  for (const linear::ModelState& state : form.states) {
    names.push_back(state.name);
    units.push_back(state.unit);
    scales.push_back(state.scale);
  }
  file.write(group + "/states/name", names,
             {"",
              "none",
              "unknowns; a state is the small change of its unknown over the scale",
              {"state"}});
  file.write(group + "/states/unit", units, {"", "none", "units of these unknowns", {"state"}});
  file.write(group + "/states/scale", scales, {scales.size()},
             {"1", "none", "unknown = scale times state", {"state"}});
  write_signals(file, group, "input", "inputs", form.inputs);
  write_signals(file, group, "output", "outputs", form.outputs);
  file.set_attribute(group, "description", form.description);
  if (form.hankel.size() > 0) {
    file.write(
        group + "/hankel_singular_values",
        std::span<const double>(form.hankel.data(), static_cast<std::size_t>(form.hankel.size())),
        {static_cast<hsize_t>(form.hankel.size())},
        {"outputs over inputs",
         "none",
         "Hankel singular values of the stable part, in descending order",
         {"hankel_singular_values"}});
    file.set_attribute(group, "error_bound", form.error_bound);
  }
  file.set_attribute(group, "harmonics", form.series.harmonics());
  file.set_attribute(group, "residual", form.series.residual());
}

void write_descriptors(Hdf5File& file, const std::vector<linear::DescriptorForm>& forms) {
  using linear::DescriptorForm;
  const auto write = [&](const std::string& name, auto member, const std::string& row,
                         const std::string& column) {
    write_stack(file, "/linearize/descriptor/" + name, forms.size(),
                [&](std::size_t i) { return Eigen::MatrixXd(forms[i].*member); }, false,
                {"SI, outputs in their units",
                 "frames of the unknowns (/model/unknowns), inputs and outputs",
                 "M z_dot + K z + R u + R_rate u_dot = 0, y = C z + C_rate z_dot + D u",
                 {"azimuth", row, column}});
  };
  write("M", &DescriptorForm::M, "row", unknown_axis);
  write("K", &DescriptorForm::K, "row", unknown_axis);
  write("R", &DescriptorForm::R, "row", "input");
  write("R_rate", &DescriptorForm::R_rate, "row", "input");
  write("C", &DescriptorForm::C, "output", unknown_axis);
  write("C_rate", &DescriptorForm::C_rate, "output", unknown_axis);
  write("D", &DescriptorForm::D, "output", "input");
}

}  // namespace

void write_linear_groups(Hdf5File& file, const linear::Linearization& linear) {
  file.write("/linearize/azimuth", linear.azimuths, {linear.azimuths.size()},
             {"rad",
              "shaft",
              "azimuth of blade 1, in at_azimuths, descriptor and operating_outputs",
              {"azimuth"}});
  file.write(
      "/linearize/operating_outputs", row_major(linear.outputs),
      {static_cast<hsize_t>(linear.outputs.rows()), static_cast<hsize_t>(linear.outputs.cols())},
      {"units of the outputs",
       "frames of the outputs",
       "outputs on the steady state",
       {"azimuth", "output"}});
  file.set_attribute("/linearize", "rotor_speed", linear.rotor_speed);
  file.set_attribute("/linearize", "is_constant", linear.is_constant ? 1 : 0);
  for (const NamedForm& form : linear.forms) write_form(file, form);
  if (!linear.descriptors.empty()) write_descriptors(file, linear.descriptors);
}

}  // namespace samara::io
