#define _GNU_SOURCE
#include "port.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <stdio.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

void port_plug(struct port* port) {
  int host_end;
  if (openpty(&port->descriptor, &host_end, NULL, NULL, NULL) != 0 ||
      ttyname_r(host_end, port->path, sizeof(port->path)) != 0) {
    perror("no pseudo-terminal can be had");
    exit(1);
  }
  struct termios settings;
  tcgetattr(host_end, &settings);
  cfmakeraw(&settings);
  tcsetattr(host_end, TCSANOW, &settings);
  close(host_end);  // from here on a hang-up tells that no host is there
  fcntl(port->descriptor, F_SETFL, O_NONBLOCK);
  printf("port %s\n", port->path);
  fflush(stdout);
}

void port_unplug(struct port* port) {
  if (port->descriptor >= 0) close(port->descriptor);
  port->descriptor = -1;
}

bool port_host_present(const struct port* port) {
  if (port->descriptor < 0) return false;
  struct pollfd entry = {.fd = port->descriptor, .events = POLLIN};
  return poll(&entry, 1, 0) >= 0 && !(entry.revents & POLLHUP);
}

size_t port_read(const struct port* port, char* data, size_t size) {
  if (port->descriptor < 0) return 0;
  const ssize_t count = read(port->descriptor, data, size);
  return count > 0 ? (size_t)count : 0;
}

void port_write(const struct port* port, const char* data, size_t size) {
  // A host that does not read loses it, as on a real line.
  if (port->descriptor >= 0 && write(port->descriptor, data, size) < 0) return;
}
