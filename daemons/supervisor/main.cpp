#include "daemons/supervisor/Supervisor.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::Supervisor>(argc, argv);
}
