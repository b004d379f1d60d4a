#include "pareto/trace.hpp"
#include "pareto_problems.hpp"
#include <cstdio>
#include <doctest/doctest.h>
using namespace percuss;
using namespace percuss::pareto;
using namespace percuss::test;

static void show(const char* name, const Front& f, std::function<double(double)> exact) {
    std::printf(
        "%s: %s points %zu evals %d (anchors %d search %d, %d searches) fail %d hv %.6f bound %.4g compared %d  %s\n",
        name, to_string(f.status), f.points.size(), f.evaluations, f.anchor_evaluations, f.search_evaluations,
        f.searches, f.failures, f.hypervolume, f.error_bound, f.compared, f.message.c_str());
    double worst = 0, kkt = 0;
    int ev[5] = {0}, cnt[5] = {0}, uncert = 0, mx = 0;
    for (auto& p : f.points) {
        if (exact) worst = std::max(worst, std::abs(exact(p.objectives[0]) - p.objectives[1]));
        kkt = std::max(kkt, p.kkt_residual);
        ev[(int)p.origin] += p.evaluations;
        cnt[(int)p.origin]++;
        uncert += !p.certified;
        if ((int)p.origin == 1 || (int)p.origin == 2) mx = std::max(mx, p.evaluations);
    }
    std::printf("   worst %.3g kkt %.3g uncertified %d max %d\n", worst, kkt, uncert, mx);
    for (int o = 0; o < 5; ++o)
        if (cnt[o])
            std::printf("   %s: %d points, %.2f evals each\n", to_string((Origin)o), cnt[o], double(ev[o]) / cnt[o]);
    for (auto& c : f.changes)
        std::printf("   change %s %d begins %d at f1 %.8f f2 %.8f width %.2g\n", c.is_bound ? "bound" : "limit",
                    c.index, c.begins, f.points[c.point].objectives[0], f.points[c.point].objectives[1], c.width);
    for (auto& g : f.gaps)
        if (g.jump || g.given_up || g.area > 1e-3)
            std::printf("   gap at %zu f1 %.4f -> %.4f area %.3g jump %d given_up %d\n", g.left,
                        f.points[g.left].objectives[0], f.points[g.left + 1].objectives[0], g.area, g.jump, g.given_up);
}
TEST_CASE("explore") {
    FrontOptions o;
    {
        auto p = limited_pair();
        show("limited", trace_front(p, o), limited_pair_front);
    }
    {
        auto p = bounded_pair();
        show("bounded", trace_front(p, o), limited_pair_front);
    }
    {
        auto p = binh_korn();
        show("bnh", trace_front(p, o), binh_korn_front);
    }
    {
        auto p = bent_valley();
        show("valley", trace_front(p, o), [](double f) { return 1 / (1 + f); });
    }
    {
        auto p = wavy();
        show("wavy", trace_front(p, o), wave);
    }
    {
        auto p = tanaka();
        show("tanaka", trace_front(p, o), nullptr);
    }
}
