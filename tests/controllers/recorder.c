/* Writes all records of each call to OUTNAME.records, one line of "number:value" each, and holds the demands that it
   finds. */
#include <stdio.h>
#include <string.h>

void DISCON(float* records, int* fail, char* input, char* output, char* message) {
  char path[8192];
  FILE* file = NULL;
  (void)message;
  *fail = 0;
  snprintf(path, sizeof path, "%s.records", output);
  file = fopen(path, records[0] < 0.5f && records[0] > -0.5f ? "w" : "a");
  if (file == NULL) {
    *fail = -1;
    return;
  }
  fprintf(file, "%d:%d %d:%d", 9001, (int)strlen(input), 9002, (int)strlen(output));
  for (int i = 0; i < 130; ++i) fprintf(file, " %d:%.9g", i + 1, (double)records[i]);
  fputc('\n', file);
  fclose(file);
}
