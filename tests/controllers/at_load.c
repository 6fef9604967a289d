/* Ends its process while it is loaded. */
#include <stdlib.h>

__attribute__((constructor)) static void leave(void) { exit(5); }

void DISCON(float* records, int* fail, char* input, char* output, char* message) {
  (void)records;
  (void)fail;
  (void)input;
  (void)output;
  (void)message;
}
