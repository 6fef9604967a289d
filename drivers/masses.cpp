#include "masses.hpp"

#include <string>

namespace samara::drivers {

void write_masses(io::ResultFile& file, const model::Masses& masses) {
  const auto write = [&file](const std::string& part, const model::MassProperties& properties,
                             const std::string& frame) {
    const Vector3 center = properties.center();
    file.write_value("/model/mass/" + part, properties.mass, {"kg", "none", "mass"});
    file.write_values("/model/center_of_mass/" + part, {center.x(), center.y(), center.z()},
                      {"m", frame, "centre of mass", {"axis"}});
  };
  write("tower", masses.tower, "n1 n2 n3 from the foot");
  write("nacelle", masses.nacelle, "y1 y2 y3 from the tower top");
  write("shaft", masses.shaft, "s1 s2 s3 from the yaw axis");
  write("hub", masses.hub, "h1 h2 h3 from the teeter pin");
  for (std::size_t k = 0; k < masses.blades.size(); ++k)
    write("blade_" + std::to_string(k + 1), masses.blades[k], "b1 b2 b3 of the root");
  write("rotor", masses.rotor, "h1 h2 h3 from the teeter pin");
  write("turbine", masses.whole, "n1 n2 n3 from the foot");
  file.write_value("/model/inertia/rotor_about_shaft", masses.rotor.inertia(1, 1),
                   {"kg m^2", "about the shaft", "hub and blades, undeformed"});
}

}  // namespace samara::drivers
