/* The law of the case key `controller` in steps: torque k w^2, and a pitch by a filter of the speed, a PI law and a gain
   schedule. INFILE has k [N m s^2/rad^2], the corner of the filter [rad/s], the set point [rad/s], both gains, and the
   angle of the schedule [rad] or 0. */
#include <math.h>
#include <stdio.h>
#include <string.h>

static struct {
  double k, corner, set_point, proportional, integral, schedule; /* of INFILE */
  double pitch;                                                   /* of the case [rad] */
  double speed_error, error, sum;                                 /* at the last call */
} law;

static int read_law(const char* path) {
  FILE* file = fopen(path, "r");
  int count = 0;
  if (file == NULL) return 0;
  count = fscanf(file, "%lf %lf %lf %lf %lf %lf", &law.k, &law.corner, &law.set_point, &law.proportional,
                 &law.integral, &law.schedule);
  fclose(file);
  return count == 6;
}

void DISCON(float* records, int* fail, char* input, char* output, char* message) {
  const double speed = records[19];
  const double interval = records[2];
  const double speed_error = speed - law.set_point;
  double angle = 0.0;
  (void)output;
  *fail = 0;
  if (records[0] < -0.5f) return;
  if (records[0] < 0.5f) {
    if (!read_law(input)) {
      *fail = -1;
      strcpy(message, "INFILE must have six numbers");
      return;
    }
    law.pitch = records[3];
    law.speed_error = speed - law.set_point;
  } else {
    const double a = 0.5 * law.corner * interval;
    const double error = ((1.0 - a) * law.error + a * (speed_error + law.speed_error)) / (1.0 + a);
    law.sum += 0.5 * interval * (error + law.error);
    law.error = error;
    law.speed_error = speed_error;
  }
  angle = law.proportional * law.error + law.integral * law.sum;
  if (law.schedule > 0.0) {
    const double start = law.schedule + law.pitch;
    angle = 0.5 * (sqrt(fmax(start * start + 4.0 * law.schedule * angle, 0.0)) - start);
  }
  records[44] = (float)(law.pitch + angle);
  for (int k = 0; k < 3; ++k) records[41 + k] = records[44];
  records[46] = (float)(law.k * speed * speed);
}
