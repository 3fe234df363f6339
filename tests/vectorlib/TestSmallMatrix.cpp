#include "vectorlib/geometry/SmallMatrix.h"

using namespace vectorlib;

// The plain loops give what Eigen's expressions give.
class TestSmallMatrix : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void products() {
        const auto a = drawn<3, 2>(), b = drawn<3, 2>();
        const auto m = drawn<2, 2>();
        const auto v = drawn<5, 1>();
        QVERIFY(product(a, m).isApprox(a * m));
        QVERIFY(product(m, Eigen::Matrix<double, 2, 1>(m.col(0))).isApprox(m * m.col(0)));
        QVERIFY(product(a, m, b).isApprox(a * m * b.transpose()));
        QVERIFY(square(-2, v).isApprox(-2 * v * v.transpose()));
    }

    void solutions() {
        for (int i = 0; i < 1000; ++i) {
            const auto a = drawn<3, 3>();
            const Eigen::Matrix3d h = a * a.transpose() + 1e-3 * Eigen::Matrix3d::Identity();
            const Eigen::Vector3d g = drawn<3, 1>();
            const auto x = solveSymmetric(h, g);
            QVERIFY2(x, saying("matrix %1", i));
            QVERIFY2((h * *x - g).norm() < 1e-10, saying("matrix %1", i));
        }
    }

    void noSolution_data() {
        const Rows<double, double, double, double> row("first", "second", "third", "right");
        row("zero", 0.0, 0.0, 0.0, 1.0);
        row("the first is zero", 0.0, 1.0, 1.0, 1.0);
        row("the second is zero", 1.0, 0.0, 1.0, 1.0);
        row("the third is zero", 1.0, 1.0, 0.0, 1.0);
        row("negative", 1.0, -1.0, 1.0, 1.0);
        row("not a number", 1.0, 1.0, std::numeric_limits<double>::quiet_NaN(), 1.0);
        row("right side not finite", 1.0, 1.0, 1.0, std::numeric_limits<double>::infinity());
    }

    void noSolution() {
        FETCH(double, first, double, second, double, third, double, right);
        const Eigen::Matrix3d h = Eigen::Vector3d(first, second, third).asDiagonal();
        QVERIFY(!solveSymmetric(h, Eigen::Vector3d(1, 1, right)));
    }

private:
    template <int Rows, int Columns>
    Eigen::Matrix<double, Rows, Columns> drawn() {
        Eigen::Matrix<double, Rows, Columns> m;
        std::uniform_real_distribution<double> value(-1, 1);
        for (int i = 0; i < m.size(); ++i)
            m(i) = value(random_);
        return m;
    }
    std::mt19937 random_{1};
};
