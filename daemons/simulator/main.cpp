#include "daemons/simulator/Simulator.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::simulator::Simulator>(argc, argv);
}
