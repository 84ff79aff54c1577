// The board's end of a pseudo-terminal.
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct port {
  int descriptor;  // -1 while unplugged
  char path[64];
};

void port_plug(struct port* port);
void port_unplug(struct port* port);
bool port_host_present(const struct port* port);
size_t port_read(const struct port* port, char* data, size_t size);
void port_write(const struct port* port, const char* data, size_t size);
