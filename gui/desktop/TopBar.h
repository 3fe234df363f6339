#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QWidget>

class QComboBox;
class QLabel;

namespace hermes {

/// What is always in sight: which robot, how good its link is, STOP.
class TopBar : public QWidget {
    Q_OBJECT
public:
    explicit TopBar(Fleet &fleet, QWidget *parent = nullptr);

private:
    void updateRobots();
    void updateLink();

    Fleet &fleet_;
    QComboBox *robots_;
    QLabel *link_;
};

} // namespace hermes
