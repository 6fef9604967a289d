/* Fails as INFILE says, at the first call from a time on: "crash 0.5". All other calls hold the torque. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char fault[64];
static double fault_time;

static void fail_by(const char* what, float* records, int* fail, char* message) {
  if (strcmp(what, "exit") == 0) exit(7);
  if (strcmp(what, "abort") == 0) abort();
  if (strcmp(what, "crash") == 0) {
    volatile int* nowhere = NULL;
    *nowhere = 1;
  }
  if (strcmp(what, "hang") == 0)
    for (;;) sleep(1);
  if (strcmp(what, "nan_torque") == 0) records[46] = NAN;
  if (strcmp(what, "infinite_pitch") == 0) records[44] = INFINITY;
  if (strcmp(what, "fail") == 0) {
    *fail = -1;
    strcpy(message, "the pitch bearing\nis stuck  ");
  }
  if (strcmp(what, "warn") == 0) {
    *fail = 1;
    strcpy(message, "the oil is warm");
  }
  if (strcmp(what, "yaw") == 0) records[47] = 0.01f;
  if (strcmp(what, "brake") == 0) records[35] = 1.0f;
  if (strcmp(what, "off") == 0) records[34] = 0.0f;
  if (strcmp(what, "overrun") == 0) memset(message, 'x', 9000);
}

void DISCON(float* records, int* fail, char* input, char* output, char* message) {
  (void)output;
  *fail = 0;
  if (records[0] < 0.5f && records[0] > -0.5f) {
    FILE* file = fopen(input, "r");
    if (file == NULL || fscanf(file, "%63s %lf", fault, &fault_time) != 2) {
      *fail = -1;
      strcpy(message, "no INFILE");
      return;
    }
    fclose(file);
  }
  if (strcmp(fault, "print") == 0) {
    printf("a word of the library\n");
    fprintf(stderr, "a complaint of the library\n");
  }
  if (records[0] < -0.5f ? strcmp(fault, "crash_at_end") == 0 : 0) abort();
  if (records[1] >= (float)fault_time - 1e-6f) fail_by(fault, records, fail, message);
}

/* Another name, as some compilers make it. */
void discon_(float* records, int* fail, char* input, char* output, char* message) {
  DISCON(records, fail, input, output, message);
}
