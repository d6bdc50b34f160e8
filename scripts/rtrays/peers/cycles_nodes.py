# SPDX-License-Identifier: MIT
"""Shader nodes of Blender as values that can be added and multiplied. Runs inside Blender."""

import math

import bpy


class Value:
    """A scalar in a shader: a constant or the output of a node. Arithmetic creates nodes or folds
    constants."""

    def __init__(self, graph, source):
        self.graph, self.source = graph, source

    def _math(self, operation, fold, *others):
        operands = [self.source] + [
            other.source if isinstance(other, Value) else other for other in others
        ]
        if all(isinstance(operand, (int, float)) for operand in operands):
            return Value(self.graph, fold(*operands))
        return Value(
            self.graph, self.graph.node("ShaderNodeMath", operands, operation=operation).outputs[0]
        )

    def __add__(self, other):
        return self._math("ADD", lambda a, b: a + b, other)

    def __sub__(self, other):
        return self._math("SUBTRACT", lambda a, b: a - b, other)

    def __rsub__(self, other):
        return Value(self.graph, other) - self

    def __mul__(self, other):
        return self._math("MULTIPLY", lambda a, b: a * b, other)

    def __truediv__(self, other):
        return self._math("DIVIDE", lambda a, b: a / b, other)

    __radd__, __rmul__ = __add__, __mul__

    def call(self, operation, *others):
        """Applies a function of ShaderNodeMath. At least one operand must not be a constant."""
        return self._math(operation, None, *others)

    def sqrt(self):
        return self._math("SQRT", math.sqrt)

    def at_least(self, bound):
        return self._math("MAXIMUM", max, bound)

    def at_most(self, bound):
        return self._math("MINIMUM", min, bound)


class Graph:
    """A node tree that is emptied except for its output node."""

    def __init__(self, tree, output):
        self.tree = tree
        tree.nodes.clear()
        self.output = tree.nodes.new(output)
        self._geometry = None

    def node(self, kind, inputs=(), **properties):
        """Adds a node. Inputs are given by position or by name and are constants or sockets; None
        leaves an input unconnected."""
        node = self.tree.nodes.new(kind)
        for name, value in properties.items():
            setattr(node, name, value)
        for key, value in inputs.items() if isinstance(inputs, dict) else enumerate(inputs):
            if isinstance(value, Value):
                value = value.source
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            elif value is not None:
                node.inputs[key].default_value = value
        return node

    def geometry(self, output):
        if self._geometry is None:
            self._geometry = self.node("ShaderNodeNewGeometry")
        return self._geometry.outputs[output]

    def backfacing(self):
        return Value(self, self.geometry("Backfacing"))

    def vector(self, values):
        """Combines three values into a socket for a vector or colour. Unlike a colour input, this
        accepts values out of range."""
        return self.node("ShaderNodeCombineXYZ", list(values)).outputs[0]

    def separated(self, socket):
        return [
            Value(self, output) for output in self.node("ShaderNodeSeparateXYZ", [socket]).outputs
        ]

    def dot(self, socket, direction):
        node = self.node("ShaderNodeVectorMath", operation="DOT_PRODUCT")
        self.tree.links.new(socket, node.inputs[0])
        if isinstance(direction, bpy.types.NodeSocket):
            self.tree.links.new(direction, node.inputs[1])
        else:
            node.inputs[1].default_value = direction
        return Value(self, node.outputs["Value"])

    def cosine(self):
        """Returns the absolute cosine between the direction to the eye and the shading normal."""
        return (
            self.dot(self.geometry("Incoming"), self.geometry("Normal"))
            .call("ABSOLUTE")
            .at_most(1.0)
        )

    def sum(self, closures):
        total = closures[0]
        for closure in closures[1:]:
            total = self.node("ShaderNodeAddShader", [total, closure]).outputs[0]
        return total
