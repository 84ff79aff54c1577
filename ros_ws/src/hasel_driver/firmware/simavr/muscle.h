// Electrical behaviour of one muscle on its converter; the same model as hasel_driver/virtual/virtual_output.py.
#pragma once

enum contact { GROUND, OPEN, POSITIVE, NEGATIVE };

struct muscle {
  double voltage_v;
  double current_a;
  double capacitance_f;
  double short_ohm;  // injected fault; HUGE_VAL without
};

void muscle_step(struct muscle* muscle, double duration_s, enum contact contact, double set_point_v);
