#include "daemons/motorcontrol/MotorControl.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::motorcontrol::MotorControl>(argc, argv);
}
