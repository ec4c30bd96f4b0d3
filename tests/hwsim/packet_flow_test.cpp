// The max-plus recurrence of packets against a simulation of every single packet, and worked out by hand.
#include "hwsim/timing/packet_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "hwsim/sample_gpu.h"
#include "hwsim/timing/time_pass.h"

namespace hwsim {
namespace {

FlowTable<double> table(std::size_t units, std::vector<double> ns, double packets, double room) {
  FlowTable<double> t;
  t.units = units;
  t.chunks = ns.size() / units;
  t.latency_ns.assign(ns.size(), 0.0);
  t.room_packets.assign(ns.size(), room);
  t.packets.assign(t.chunks, packets);
  t.ns = std::move(ns);
  return t;
}

/// Tandem queues with finite room, packet by packet (a packet starts where it has arrived, the server is
/// free, and the one after it has done the packet that came `room` before).
double each_packet(const FlowTable<double>& t) {
  std::vector<std::vector<double>> done(t.units);
  double last = 0.0;
  for (std::size_t k = 0; k < t.chunks; ++k)
    for (int p = 0; p < static_cast<int>(t.packets[k]); ++p)
      for (std::size_t u = 0; u < t.units; ++u) {
        const std::size_t i = k * t.units + u, n = done[u].size();
        double start = n > 0 ? done[u].back() : 0.0;
        if (u > 0) start = std::max(start, done[u - 1].back() + t.latency_ns[i - 1]);
        const auto room = static_cast<std::size_t>(t.room_packets[i]);
        if (u + 1 < t.units && n >= room) start = std::max(start, done[u + 1][n - room]);
        done[u].push_back(start + t.ns[i] / t.packets[k]);
        last = std::max(last, done[u].back());
      }
  return last;
}

TEST(PacketFlow, OnePacketAChunkIsTheTandemQueueWorkedOutByHand) {
  // chunk 0: 2 3 1, chunk 1: 4 1 2, chunk 2: 1 5 1
  // done:    2 5 6,          6 7 9,          7 12 13
  const FlowResult<double> r = PacketFlow<double>(table(3, {2, 3, 1, 4, 1, 2, 1, 5, 1}, 1.0, 8.0)).run();
  EXPECT_DOUBLE_EQ(r.makespan_ns, 13.0);
  EXPECT_NEAR(std::accumulate(r.critical_ns.begin(), r.critical_ns.end(), 0.0), 13.0, 1e-9);
}

TEST(PacketFlow, UnitsWorkOnTheSameChunkAtOnce) {
  // 100 packets of 1, 3 and 2: the slowest sets the pace, the others add one packet each.
  const FlowResult<double> r = PacketFlow<double>(table(3, {100, 300, 200}, 100.0, 64.0)).run();
  EXPECT_DOUBLE_EQ(r.makespan_ns, 300.0 + 1 + 2);
  EXPECT_NEAR(r.critical_ns[1], 300.0, 1e-9);
}

TEST(PacketFlow, ChunksThatLoadDifferentUnitsOverlapAsFarAsTheQueueReaches) {
  std::vector<double> ns;
  for (int k = 0; k < 10; ++k) ns.insert(ns.end(), {k % 2 == 0 ? 100.0 : 10.0, k % 2 == 0 ? 10.0 : 100.0});
  const auto time = [&](double room) {
    const FlowTable<double> t = table(2, ns, 100.0, room);
    const double flow = PacketFlow<double>(t).run().makespan_ns;
    EXPECT_NEAR(flow / each_packet(t), 1.0, 0.04) << room;
    return flow;
  };
  EXPECT_GT(time(4), 950.0);    // hardly any overlap: ten times the larger
  EXPECT_LT(time(400), 700.0);  // 550 and the fill
  EXPECT_GT(time(50), time(200));
}

TEST(PacketFlow, IsNearEverySinglePacket) {
  unsigned state = 7;
  const auto random = [&state] {
    return static_cast<double>((state = state * 1664525u + 1013904223u) >> 24);
  };
  for (const double room : {8.0, 16.0, 64.0, 300.0}) {
    std::vector<double> ns;
    for (int i = 0; i < 5 * 60; ++i) ns.push_back(10.0 + random());
    FlowTable<double> t = table(5, ns, 20.0, room);
    for (double& packets : t.packets) packets = 1.0 + std::floor(random() / 8.0);
    const FlowResult<double> r = PacketFlow<double>(t).run();
    EXPECT_NEAR(r.makespan_ns / each_packet(t), 1.0, 0.05) << room;
    EXPECT_NEAR(std::accumulate(r.critical_ns.begin(), r.critical_ns.end(), 0.0), r.makespan_ns, 1e-6);
    for (const double part : r.critical_ns) EXPECT_GE(part, 0.0);
  }
}

TEST(PacketFlow, ALatencyIsPaidOnceWhereEnoughPacketsAreOnTheirWay) {
  FlowTable<double> t = table(2, {100, 100, 100, 100}, 100.0, 1000.0);
  t.latency_ns[0] = t.latency_ns[2] = 50.0;
  EXPECT_DOUBLE_EQ(PacketFlow<double>(t).run().makespan_ns, 200.0 + 50 + 1);
}

TEST(PacketFlow, NothingToDoTakesNoTime) {
  EXPECT_DOUBLE_EQ(PacketFlow<double>(table(3, {}, 1.0, 2.0)).run().makespan_ns, 0.0);
}

/// How far the cores may run ahead of L2 in each of two chunks of ten packets.
std::vector<double> room_of_cores(double fills_of_first, double fills_of_second) {
  std::vector<ChunkCost<double>> costs(2);
  for (ChunkCost<double>& cost : costs) {
    cost.packets = 10.0;
    cost.line_fills = 2.0;  // five packets' lines are on their way at most
  }
  costs[0].core_fills = fills_of_first;
  costs[1].core_fills = fills_of_second;
  GpuRates<double> rates = derive_rates<double>(test::sample_gpu());
  rates.queue_packets = 4.0;
  const auto flow = flow_table(costs, {index_of(Unit::shader), index_of(Unit::l2)}, rates);
  return {flow.room_packets[0], flow.room_packets[2]};
}

// Depth alone: nothing stays in the cores, so that the queue and the lines on their way are all the room.
TEST(Room, PacketsWithoutSubgroupsWaitForTheirLines) {
  EXPECT_EQ(room_of_cores(0.0, 0.0), (std::vector<double>{4.0 + 5.0, 4.0 + 5.0}));
}

// Five packets fill the cores.
TEST(Room, PacketsInTheCoresAddToIt) { EXPECT_EQ(room_of_cores(2.0, 2.0)[1], 4.0 + 5.0 + 5.0); }

// A few subgroups among many packets: those without pass between them, and all of them have room.
TEST(Room, FewSubgroupsAmongManyPacketsHoldNoneBack) {
  EXPECT_EQ(room_of_cores(0.25, 0.25), (std::vector<double>{4.0 + 5.0 + 21.0, 4.0 + 5.0 + 41.0}));
}

}  // namespace
}  // namespace hwsim
