#include "daemons/softwaretrigger/SoftwareTrigger.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::softwaretrigger::SoftwareTrigger>(argc, argv);
}
