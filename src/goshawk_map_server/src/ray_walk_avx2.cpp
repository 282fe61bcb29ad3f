#include "ray_walk.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
// Of functions, not of the file: inline functions of headers must not be compiled for AVX2 here and
// be used elsewhere.
#define GOSHAWK_AVX2 __attribute__((target("avx2")))
#endif

namespace goshawk::map_server {

#ifdef GOSHAWK_AVX2
namespace {

constexpr std::size_t kRays = 4;

// The same member of four rays, one a lane.
template <std::int64_t RayWalk::*kMember>
GOSHAWK_AVX2 __m256i lanes(RayWalk* const (&walk)[kRays]) {
  return _mm256_set_epi64x(walk[3]->*kMember, walk[2]->*kMember, walk[1]->*kMember,
                           walk[0]->*kMember);
}

template <std::int64_t RayWalk::*kMember>
GOSHAWK_AVX2 void store(RayWalk* const (&walk)[kRays], __m256i values) {
  alignas(32) std::int64_t value[kRays];
  _mm256_store_si256(reinterpret_cast<__m256i*>(value), values);
  for (std::size_t k = 0; k < kRays; ++k) walk[k]->*kMember = value[k];
}

// RowBits::put for four runs.
GOSHAWK_AVX2 inline void put_four(const RowBits& bits, __m256i row, __m256i low, __m256i high) {
  const __m256i ones = _mm256_set1_epi64x(-1), in_word = _mm256_set1_epi64x(63);
  alignas(32) std::int64_t at[kRays], first[kRays], last[kRays];
  alignas(32) RowBits::Word mask[kRays];
  if (_mm256_testc_si256(in_word, _mm256_xor_si256(low, high)) == 0) {  // a run over two words
    _mm256_store_si256(reinterpret_cast<__m256i*>(at), row);
    _mm256_store_si256(reinterpret_cast<__m256i*>(first), low);
    _mm256_store_si256(reinterpret_cast<__m256i*>(last), high);
    for (std::size_t k = 0; k < kRays; ++k) bits.put(at[k], first[k], last[k]);
    return;
  }
  const __m256i from = _mm256_sllv_epi64(ones, _mm256_and_si256(low, in_word));
  const __m256i to = _mm256_srlv_epi64(ones, _mm256_andnot_si256(high, in_word));
  const __m256i word = _mm256_mul_epu32(_mm256_srli_epi64(low, 6), _mm256_set1_epi64x(bits.plane));
  _mm256_store_si256(reinterpret_cast<__m256i*>(at), _mm256_add_epi64(row, word));
  _mm256_store_si256(reinterpret_cast<__m256i*>(mask), _mm256_and_si256(from, to));
  for (std::size_t k = 0; k < kRays; ++k) bits.words[at[k]] |= mask[k];
}

// As many steps as all four have. Numbers of voxels and places are within 31 and 63 bits, and not
// below zero.
template <bool kUp>
GOSHAWK_AVX2 void walk_four(const RowBits& bits, RayWalk* const (&walk)[kRays],
                            std::int64_t steps) {
  const __m256i zero = _mm256_setzero_si256();
  const __m256i every_y = lanes<&RayWalk::every_y>(walk), both = lanes<&RayWalk::both>(walk);
  const __m256i advance_y = lanes<&RayWalk::advance_y>(walk);
  const __m256i advance_z = lanes<&RayWalk::advance_z>(walk);
  const __m256i row_y = lanes<&RayWalk::row_y>(walk), row_more = lanes<&RayWalk::row_more>(walk);
  __m256i until_z = lanes<&RayWalk::until_z>(walk);
  __m256i place_y = lanes<&RayWalk::place_y>(walk), place_z = lanes<&RayWalk::place_z>(walk);
  __m256i row = lanes<&RayWalk::row>(walk), x = lanes<&RayWalk::x>(walk);
  for (std::int64_t k = 0; k < steps; ++k) {
    const __m256i by_z = _mm256_cmpgt_epi64(zero, until_z);
    const __m256i place =
        _mm256_srli_epi64(_mm256_blendv_epi8(place_y, place_z, by_z), RayWalk::kFraction);
    const __m256i next = kUp ? _mm256_max_epi32(x, place) : _mm256_min_epi32(x, place);
    put_four(bits, row, kUp ? x : next, kUp ? next : x);
    x = next;
    until_z = _mm256_sub_epi64(_mm256_add_epi64(until_z, _mm256_and_si256(both, by_z)), every_y);
    place_y = _mm256_add_epi64(place_y, _mm256_andnot_si256(by_z, advance_y));
    place_z = _mm256_add_epi64(place_z, _mm256_and_si256(advance_z, by_z));
    row = _mm256_add_epi64(row, _mm256_add_epi64(row_y, _mm256_and_si256(row_more, by_z)));
  }
  store<&RayWalk::until_z>(walk, until_z);
  store<&RayWalk::place_y>(walk, place_y);
  store<&RayWalk::place_z>(walk, place_z);
  store<&RayWalk::row>(walk, row);
  store<&RayWalk::x>(walk, x);
  for (RayWalk* w : walk) w->rows_left -= steps;
}

GOSHAWK_AVX2 void walk_fours(const RowBits& bits, std::span<RayWalk> walks,
                             std::span<const std::uint16_t> order, bool up) {
  for (std::size_t k = 0; k + kRays <= order.size(); k += kRays) {
    RayWalk* const four[kRays] = {&walks[order[k]], &walks[order[k + 1]], &walks[order[k + 2]],
                                  &walks[order[k + 3]]};
    std::int64_t steps = four[0]->rows_left;
    for (const RayWalk* w : four) steps = w->rows_left < steps ? w->rows_left : steps;
    up ? walk_four<true>(bits, four, steps) : walk_four<false>(bits, four, steps);
  }
  walk_rows(bits, walks, order, up);  // to their ends, each
}

}  // namespace

WalkRows walk_rows_avx2() {
  return __builtin_cpu_supports("avx2") != 0 ? walk_fours : nullptr;
}
#else
WalkRows walk_rows_avx2() {
  return nullptr;
}
#endif

}  // namespace goshawk::map_server
