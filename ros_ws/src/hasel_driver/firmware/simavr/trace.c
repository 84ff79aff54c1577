#include "trace.h"

#include <stdio.h>
#include <string.h>

static void trace_line(const char* line, double time_s) {
  const char* const command = strstr(line, "SET VOLTAGE ");
  int upper, lower;
  if (command && sscanf(command, "SET VOLTAGE %d %d", &upper, &lower) == 2) {
    printf("wire %.6f %d %d\n", time_s, upper, lower);
    fflush(stdout);
  }
}

void trace_commands(const char* data, size_t size, double time_s) {
  static char line[128];
  static size_t length;
  for (size_t i = 0; i < size; ++i) {
    if (data[i] != '\n') {
      if (length + 1 < sizeof(line)) line[length++] = data[i];
      continue;
    }
    line[length] = '\0';
    length = 0;
    trace_line(line, time_s);
  }
}
