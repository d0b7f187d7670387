#!/usr/bin/python3
"""Writes reference.bin beside this file: the network of hv_explore_sac once more in PyTorch, its
scores and the gradient of every parameter, for reference_test.cpp to compare with.

Run by hand when the architecture changes (Debian: python3-torch):

    /usr/bin/python3 make_reference.py

Neighbour lists are masks of dense attention here, and the LSTM's cell is PyTorch's own, so that
little is shared with the code under test. The file is a count, then for each array a name (length and
bytes), rows, columns (all u32) and floats, little endian.
"""
import math
import os
import struct

import torch
import torch.nn.functional as F

NODES, FEATURES, GLOBALS, OUTPUTS = 12, 4, 2, 2
WIDTH, HEADS, HIDDEN, LAYERS, LEVELS, MEMORY, STEPS = 8, 2, 12, 2, 2, 6, 5

torch.manual_seed(1)
torch.set_default_dtype(torch.float64)
parameters = {}


def parameter(name, rows, cols):
    if name not in parameters:
        # Rounded to what the file can hold.
        values = (torch.randn(rows, cols) * 0.4).float().double()
        parameters[name] = values.requires_grad_()
    return parameters[name]


def linear(name, x, outputs):
    return x @ parameter(name + ".weight", x.shape[1], outputs) + parameter(
        name + ".bias", 1, outputs)


def layer_norm(name, x):
    return F.layer_norm(x, (x.shape[1],), parameter(name + ".gain", 1, x.shape[1])[0],
                        parameter(name + ".shift", 1, x.shape[1])[0])


def edge_features(positions, others):
    way = others[None, :, :] - positions[:, None, :]
    return torch.cat([way, way.norm(dim=2, keepdim=True)], dim=2)


def attention(name, queries, memory, mask, edges):
    q = linear(name + ".query", queries, WIDTH)
    k, v = linear(name + ".key_value", memory, 2 * WIDTH).split(WIDTH, dim=1)
    # parameters in the order of the C++ layout: output before edge_bias
    parameter(name + ".output.weight", WIDTH, WIDTH)
    parameter(name + ".output.bias", 1, WIDTH)
    bias = (edges @ parameter(name + ".edge_bias", 3, HEADS)).permute(2, 0, 1)
    depth = WIDTH // HEADS
    split = lambda x: x.view(-1, HEADS, depth).transpose(0, 1)
    scores = split(q) @ split(k).transpose(1, 2) / math.sqrt(depth) + bias
    weights = scores.masked_fill(~mask, float("-inf")).softmax(dim=2)
    mixed = (weights @ split(v)).transpose(0, 1).reshape(-1, WIDTH)
    return linear(name + ".output", mixed, WIDTH)


def encoder_layer(name, x, mask, edges):
    near = layer_norm(name + ".norm_attention", x)
    x = x + attention(name + ".attention", near, near, mask, edges)
    own = layer_norm(name + ".norm_feed_forward", x)
    hidden = torch.relu(linear(name + ".feed_forward.expand", own, HIDDEN))
    return x + linear(name + ".feed_forward.contract", hidden, WIDTH)


def coarsen(positions, mask, centre):
    """Clusters as a matrix [clusters x nodes] of ones, and their mask."""
    order = sorted(range(len(positions)),
                   key=lambda i: float((positions[i] - centre).square().sum()))
    parent = [None] * len(positions)
    clusters = 0
    for seed in order:
        if parent[seed] is None:
            for i in range(len(positions)):
                if mask[seed, i] and parent[i] is None:
                    parent[i] = clusters
            clusters += 1
    members = F.one_hot(torch.tensor(parent), clusters).T.double()
    return members, (members @ mask.double() @ members.T) > 0


def pyramid(x, positions, mask, centre):
    scales = [(x, None)]
    for level in range(LEVELS):
        members, mask = coarsen(positions, mask, centre)
        mean = members / members.sum(dim=1, keepdim=True)
        positions = mean @ positions
        x = encoder_layer(f"pyramid{level}.layer", mean @ x, mask,
                          edge_features(positions, positions))
        scales.append((x, members))
    fused = scales[-1][0]
    for level in reversed(range(LEVELS)):
        x, up = scales[level][0], scales[level + 1][1].T
        detail = linear(f"pyramid{level}.lateral", x, WIDTH) + up @ linear(
            f"pyramid{level}.top", fused, WIDTH)
        fused = x + torch.relu(detail)
    return fused


def memory(history):
    state = torch.zeros(1, MEMORY), torch.zeros(1, MEMORY)
    weights = (parameter("memory.input.weight", FEATURES, 4 * MEMORY).T,
               parameter("memory.recurrent", MEMORY, 4 * MEMORY).T,
               parameter("memory.input.bias", 1, 4 * MEMORY)[0], torch.zeros(4 * MEMORY))
    for step in history:
        state = torch.lstm_cell(step[None], state, *weights)
    return state[0]


def decode(nodes, current, actions, positions, state_memory, state_globals):
    edges = edge_features(positions[current:current + 1], positions)
    everything = torch.ones(1, len(nodes), dtype=torch.bool)
    here = nodes[current:current + 1]
    context = attention("decoder.attention", here, nodes, everything, edges)
    state = torch.relu(linear("decoder.state",
                              torch.cat([here, context, state_memory, state_globals], 1), WIDTH))
    pointer = torch.cat([state.expand(len(actions), -1), nodes[actions], edges[0][actions]], 1)
    hidden = torch.relu(linear("decoder.pointer", pointer, OUTPUTS * WIDTH))
    heads = hidden.view(-1, OUTPUTS, WIDTH)
    weight = parameter("decoder.score.weight", WIDTH, OUTPUTS)
    return torch.einsum("aow,wo->ao", heads, weight) + parameter("decoder.score.bias", 1, OUTPUTS)


def write(path, arrays):
    with open(path, "wb") as file:
        file.write(struct.pack("<I", len(arrays)))
        for name, array in arrays.items():
            file.write(struct.pack("<I", len(name)) + name.encode())
            file.write(struct.pack("<II", *array.shape))
            file.write(array.detach().float().numpy().tobytes())


def main():
    round_ = lambda x: x.float().double()
    features = round_(torch.randn(NODES, FEATURES))
    positions = round_(torch.rand(NODES, 2) * 4.0)
    history = round_(torch.randn(STEPS, FEATURES))
    state_globals = round_(torch.randn(1, GLOBALS))
    distance = torch.cdist(positions, positions)
    mask = distance <= distance.sort(dim=1).values[:, 3:4]
    mask = mask | mask.T
    current = 5
    actions = [i for i in range(NODES) if mask[current, i] and i != current]

    x = linear("embedding", features, WIDTH)
    edges = edge_features(positions, positions)
    for layer in range(LAYERS):
        x = encoder_layer(f"encoder{layer}", x, mask, edges)
    x = layer_norm("encoder_norm", x)
    nodes = pyramid(x, positions, mask, positions[current])
    scores = decode(nodes, current, actions, positions, memory(history), state_globals)
    d_scores = round_(torch.randn_like(scores))
    (scores * d_scores).sum().backward()

    arrays = {
        "features": features, "positions": positions, "history": history,
        "globals": state_globals, "mask": mask, "current": torch.tensor([[current]]),
        "actions": torch.tensor([actions]), "scores": scores, "d_scores": d_scores,
    }
    for name, value in parameters.items():
        arrays["parameter." + name] = value
        arrays["gradient." + name] = value.grad
    write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "reference.bin"), arrays)


if __name__ == "__main__":
    main()
