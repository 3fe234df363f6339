#include "daemons/velodynelogger/VelodyneLogger.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::VelodyneLogger>(argc, argv);
}
