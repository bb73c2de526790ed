// The tracker of experiments/own_filter as one writes it without credence: one trial after the other on fixed-size
// Eigen, NEES and nothing else.
//   loop DRAWS NEES     the trials of these draws [trial, step, 5], doubles; writes NEES/n of each trial
//   loop SEED TRIALS -  draws of its own; prints seconds of processor time a trial

#include <Eigen/Dense>

#include <ctime>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

constexpr int steps = 49, draws_of_step = 5;

struct Model {
    Eigen::Matrix4d F = Eigen::Matrix4d::Identity(), Q;
    Eigen::Matrix<double, 4, 2> G;
    Model() {
        F.topRightCorner<2, 2>().setIdentity();
        G << Eigen::Matrix2d::Identity() / 2, Eigen::Matrix2d::Identity();
        Q = 0.04 * G * G.transpose();
    }
};

/// NEES/n of a trial. `draw` gives the next normal number, `uniform` the next uniform one.
template <class Normal, class Uniform>
double trial(const Model& model, Normal normal, Uniform uniform) {
    using Eigen::Matrix2d, Eigen::Vector2d, Eigen::Vector4d, Eigen::Matrix4d;
    const auto pair = [&] {
        const double first = normal();
        return Vector2d(first, normal());
    };
    Vector4d x, estimate = Vector4d::Zero();
    x.head<2>() = 50 * pair();
    x.tail<2>() = 5 * pair();
    Matrix4d P = Vector4d(2500, 2500, 25, 25).asDiagonal();
    double nees = 0;
    for (int k = 0; k < steps; ++k) {
        x = model.F * x + model.G * (0.2 * pair());
        estimate = model.F * estimate;
        P = model.F * P * model.F.transpose() + model.Q;
        const Vector2d innovation = x.head<2>() + 2 * pair() - estimate.head<2>();
        if (uniform() < 0.9) {
            const Matrix2d S = P.topLeftCorner<2, 2>() + 4 * Matrix2d::Identity();
            const Eigen::Matrix<double, 4, 2> K = P.leftCols<2>() * S.inverse();
            estimate += K * innovation;
            P -= K * S * K.transpose();
        }
        const Vector4d e = estimate - x;
        nees += P.llt().matrixL().solve(e).squaredNorm();
    }
    return nees / steps / 4;
}

int main(int, char** argv) {
    const Model model;
    if (std::string(argv[3] == nullptr ? "" : argv[3]) == "-") {
        std::mt19937_64 random(std::stoull(argv[1]));
        std::normal_distribution<double> normal;
        std::uniform_real_distribution<double> uniform;
        const int trials = std::stoi(argv[2]);
        double sum = 0;
        const std::clock_t start = std::clock();
        for (int i = 0; i < trials; ++i)
            sum += trial(
                model, [&] { return normal(random); }, [&] { return uniform(random); });
        std::cout << double(std::clock() - start) / CLOCKS_PER_SEC / trials << ' ' << sum / trials << '\n';
        return 0;
    }
    std::ifstream in(argv[1], std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const auto* draws = reinterpret_cast<const double*>(bytes.data());
    constexpr int of_trial = (1 + steps) * draws_of_step;  // the first step's are those of the start
    std::vector<double> all;
    for (std::size_t i = 0; i < bytes.size() / sizeof(double) / of_trial; ++i) {
        const double* next = draws + i * of_trial;
        int normals = 0, uniforms = 0;
        all.push_back(trial(
            model,
            [&] {
                const int at = normals < 4 ? normals : 5 + (normals - 4) / 4 * draws_of_step + (normals - 4) % 4;
                ++normals;
                return next[at];
            },
            [&] { return next[(1 + uniforms++) * draws_of_step + 4]; }));
    }
    std::ofstream(argv[2], std::ios::binary)
        .write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size() * sizeof(double)));
}
