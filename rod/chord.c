#include "rod/chord.h"

Chord chord_at(const RodTerm *term, int pack, const double *x, const Pack *own)
{
    Chord chord = {.s = segment_at(&term->layout, pack, x, own),
                   .h = rod_term_length(term, pack),
                   .stretches = term->layout.strain >= 0};
    Pack3 bow = rod_term_vector(term, pack, &term->rod->bow[0].x);
    chord.C = pack3_axpy(chord.h, segment_chord(&chord.s), bow);
    if (!chord.stretches) return chord;
    chord.V = pack3_scale(chord.h / 2, pack3_load(own + 6));
    chord.C = pack3_add(chord.C, chord.V);
    return chord;
}

Pack3 chord_world(const Chord *chord)
{
    Pack3 way = segment_to_world(&chord->s, chord->C);
    return chord->stretches ? pack3_add(way, segment_to_world_b(&chord->s, chord->V)) : way;
}

/* dC of turns, in the frame of a. */
static Pack3 body_rate(const Chord *chord, Pack3 turn_a, Pack3 turn_b)
{
    return pack3_scale(chord->h, segment_chord_rate(&chord->s, segment_rate(&chord->s, turn_a, turn_b)));
}

Pack3 chord_rate(const Chord *chord, Pack3 turn_a, Pack3 turn_b)
{
    Pack3 rate = segment_to_world(&chord->s,
                                  pack3_add(body_rate(chord, turn_a, turn_b), pack3_cross(turn_a, chord->C)));
    if (!chord->stretches) return rate;
    return pack3_add(rate, segment_to_world_b(&chord->s, pack3_cross(turn_b, chord->V)));
}

Pack3 chord_strain_rate(const Chord *chord, Pack3 strain)
{
    Pack3 half = pack3_scale(chord->h / 2, strain);
    return pack3_add(segment_to_world(&chord->s, half), segment_to_world_b(&chord->s, half));
}

/* The force in the frame of a is F = R_a^T T, which changes by -phi_a x F: so -F.C gains phi_a.(F x C). In that of
 * b it is F_b. */
void chord_gradient(const Chord *chord, Pack3 T, Pack *g)
{
    Pack3 F = segment_to_body(&chord->s, T), own = pack3_cross(F, chord->C);
    Jet jet = segment_chord_jet(&chord->s, pack3_scale(-chord->h, F), false);
    segment_pull_gradient(&chord->s, &jet, g);
    pack3_store(g, pack3_add(pack3_load(g), own));
    if (!chord->stretches) return;
    Pack3 Fb = segment_to_body_b(&chord->s, T);
    pack3_store(g + 3, pack3_add(pack3_load(g + 3), pack3_cross(Fb, chord->V)));
    pack3_store(g + 6, pack3_sub(pack3_load(g + 6), pack3_scale(chord->h / 2, pack3_add(F, Fb))));
}

/* The second derivative of -F.C, C fixed in the frame that turns. */
static void add_carried(PackMat *block, Pack3 F, Pack3 C)
{
    *block = pack_mat_add(*block, pack_mat_scale(pack_set(-0.5), pack_mat_symmetric(C, F)));
    *block = pack_mat_add(*block, pack_mat_diagonal(pack3_dot(C, F)));
}

/* [F]x dC of the turns of a or of b. */
static PackMat mixed(const Chord *chord, Pack3 F, bool b)
{
    Pack3 zero = {{0}, {0}, {0}}, row[3];
    for (int i = 0; i < 3; i++) {
        Pack3 unit = pack3(pack_set(i == 0), pack_set(i == 1), pack_set(i == 2));
        row[i] = pack3_cross(F, b ? body_rate(chord, zero, unit) : body_rate(chord, unit, zero));
    }
    return pack_mat_transpose((PackMat){row[0], row[1], row[2]});
}

void chord_hessian(const Chord *chord, Pack3 T, PackMat block[3])
{
    Pack3 F = segment_to_body(&chord->s, T), C = chord->C;
    Jet jet = segment_chord_jet(&chord->s, pack3_scale(-chord->h, F), true);
    segment_pull_hessian(&chord->s, &jet, block);
    PackMat a = mixed(chord, F, false);
    block[0] = pack_mat_add(block[0], pack_mat_add(a, pack_mat_transpose(a)));
    add_carried(&block[0], F, C);
    block[1] = pack_mat_add(block[1], mixed(chord, F, true));
    if (chord->stretches) add_carried(&block[2], segment_to_body_b(&chord->s, T), chord->V);
}

void chord_mixed_hessian(const Chord *chord, Pack3 T, PackMat block[2])
{
    Pack3 F[2] = {segment_to_body(&chord->s, T), segment_to_body_b(&chord->s, T)};
    for (int k = 0; k < 2; k++) block[k] = pack_mat_scale(-chord->h / 2, pack_mat_cross(F[k]));
}
