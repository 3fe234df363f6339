#pragma once

namespace hermes {

/// Of a serial line or pseudo-terminal, bits a second, as it goes out; 0: the file is none. <termios.h> knows
/// but some speeds.
int speedOf(int file);
/// Any speed, both ways. False: the file is none, or its driver refuses.
bool setSpeed(int file, int baud);

} // namespace hermes
