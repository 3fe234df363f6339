#include "daemons/seriallogger/SerialLogger.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::seriallogger::SerialLogger>(argc, argv);
}
