#include "daemons/velodynelogger/VelodyneLogger.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::velodynelogger::VelodyneLogger>(argc, argv);
}
