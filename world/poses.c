#include "world/poses.h"
#include "base/memory.h"

static void put(const Obstacle *obstacle, double time, RigidPose *pose)
{
    if (obstacle_pose(obstacle, time, pose, NULL)) return;
    for (int i = 0; i < 3; i++) pose->shift[i] = NAN;
}

static void put_all(Poses *poses, double time, double dt)
{
    for (int k = 0; k < poses->count; k++) {
        put(&poses->obstacles[k], time, &poses->end[k]);
        put(&poses->obstacles[k], time - dt, &poses->start[k]);
    }
    poses->time = time, poses->dt = dt;
    poses->known = true;
}

Poses poses_create(const Obstacle *obstacles, int count)
{
    Poses poses = {.obstacles = obstacles, .count = count};
    poses.end = mem_alloc((size_t)count, sizeof *poses.end);
    poses.start = mem_alloc((size_t)count, sizeof *poses.start);
    for (int k = 0; k < count; k++)
        poses.moves = poses.moves || timed_is_given(&obstacles[k].motion.move) ||
                      timed_is_given(&obstacles[k].motion.turn);
    if (!poses.moves) put_all(&poses, 0, 0);
    return poses;
}

void poses_destroy(Poses *poses)
{
    mem_free(poses->end);
    mem_free(poses->start);
}

bool poses_update(Poses *poses, const Point *at)
{
    bool first = !poses->known;
    if (first || at->time != poses->time || at->dt != poses->dt) put_all(poses, at->time, at->dt);
    return first;
}
