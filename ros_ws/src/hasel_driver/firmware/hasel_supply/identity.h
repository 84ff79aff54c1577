// What this firmware calls itself.
#pragma once

constexpr char IDENTITY[] = "hasel-supply 1.0 protocol 1";
