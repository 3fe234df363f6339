#include "daemons/supervisor/Supervisor.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::supervisor::Supervisor>(argc, argv);
}
