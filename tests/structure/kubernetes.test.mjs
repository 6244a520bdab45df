// SPDX-License-Identifier: Apache-2.0
// The manifests of deploy/kubernetes: each document is of the type that Kubernetes' API says (types
// made of its OpenAPI schema), and what one names the others have: ports, services, secrets, keys,
// options of programs, images.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { after, test } from 'node:test';
import { load_module, run } from '../server.mjs';

const yaml = load_module('yaml'), ts = load_module('typescript');
load_module('kubernetes-types/package.json');
const root = process.env.WELLSPRING_SOURCE, deploy = join(root, 'deploy');
const read = (...path) => readFileSync(join(root, ...path), 'utf8');
const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
after(() => rmSync(folder, { recursive: true, force: true }));

// As Kubernetes reads it, whose numbers with a leading 0 are octal. No key stands twice.
function documents(name) {
  return yaml.parseAllDocuments(read('deploy', name), { version: '1.1', uniqueKeys: true })
      .map((one) => {
        assert.deepEqual(one.errors, [], name);
        return one.toJS();
      });
}
const kustomization = documents('kustomization.yaml')[0];
const all = kustomization.resources.flatMap(documents);
const of_kind = (kind) => all.filter((one) => one.kind === kind);
const named = (kind, name) => of_kind(kind).find(({ metadata }) => metadata.name === name)
    ?? assert.fail(`there is no ${kind} ${name}`);
const workloads = [...of_kind('Deployment'), ...of_kind('StatefulSet')];
const pod_of = (one) => one.spec.template.spec;
const app_of = (one) => one.spec.template.metadata.labels.app;
const of_app = (app) => workloads.find((one) => app_of(one) === app)
    ?? assert.fail(`nothing has the label app: ${app}`);

// What the API's types have against a document, as the TypeScript compiler says it; it refuses
// fields that a type does not have.
const modules = join(process.env.WELLSPRING_NODE, 'node_modules');
const parsed = new Map();  // files of types
function problems(documents_) {
  const file = join(modules, 'manifests.ts');
  const text = documents_.map((one, i) => {
    const group = one.apiVersion === 'v1' ? 'core/v1' : one.apiVersion.replace(/\..*\//, '/');
    return `const one_${i}: import('kubernetes-types/${group}').${one.kind} = ` +
        `${JSON.stringify(one)};\n`;
  }).join('') + 'export {};\n';
  const options = { noEmit: true, strict: true, skipLibCheck: true, types: [],
    target: ts.ScriptTarget.ES2022, module: ts.ModuleKind.ESNext,
    moduleResolution: ts.ModuleResolutionKind.Bundler };
  const host = ts.createCompilerHost(options);
  const { getSourceFile, fileExists } = host;
  host.getSourceFile = (name, ...more) => {
    if (name === file) return ts.createSourceFile(name, text, ts.ScriptTarget.ES2022);
    if (!parsed.has(name)) parsed.set(name, getSourceFile(name, ...more));
    return parsed.get(name);
  };
  host.fileExists = (name) => name === file || fileExists(name);
  return ts.getPreEmitDiagnostics(ts.createProgram([file], options, host))
      .map(({ messageText }) => ts.flattenDiagnosticMessageText(messageText, ' '));
}

test('every file of the folder is named, and every document is what the API takes', () => {
  const files = readdirSync(join(deploy, 'kubernetes')).filter((name) => name.endsWith('.yaml'));
  assert.deepEqual(kustomization.resources.map((name) => basename(name)).sort(), files.sort());
  assert.deepEqual(problems(all), []);
  for (const { metadata } of all) assert.match(metadata.name, /^[a-z]([-a-z0-9]*[a-z0-9])?$/);
});

test('a damaged document is refused', () => {
  const damages = {
    'a key that is not': (one) => { one.spec.replica = 3; },
    'a key one level too high': (one) => { one.spec.containers = pod_of(one).containers; },
    'a text for a number': (one) => { pod_of(one).containers[0].ports[0].containerPort = '80'; },
    'no selector': (one) => { delete one.spec.selector; },
    'a container without a name': (one) => { delete pod_of(one).containers[0].name; },
    'a probe that is misspelt': (one) => { pod_of(one).containers[0].readynessProbe = {}; },
    'no such kind': (one) => { one.kind = 'Deploiment'; },
    'no such version': (one) => { one.apiVersion = 'apps/v3'; },
  };
  for (const [what, damage] of Object.entries(damages)) {
    const one = structuredClone(named('Deployment', 'server'));
    damage(one);
    assert.notDeepEqual(problems([one]), [], what);
  }
});

const port_names = (one) => pod_of(one).containers[0].ports?.map(({ name }) => name) ?? [];

test('services, policies and budgets are for pods that there are, and their ports', () => {
  for (const one of workloads) {
    assert.deepEqual(one.spec.selector.matchLabels, { app: app_of(one) });
    for (const probe of ['startupProbe', 'readinessProbe', 'livenessProbe']) {
      const asked = pod_of(one).containers[0][probe];
      if (asked) assert.ok(port_names(one).includes((asked.httpGet ?? asked.tcpSocket).port));
    }
  }
  for (const { spec } of of_kind('Service'))
    for (const { port, targetPort } of spec.ports) {
      const [container] = pod_of(of_app(spec.selector.app)).containers;
      const own = container.ports.find(({ name }) => name === targetPort);
      assert.ok(own, `${targetPort} of ${spec.selector.app}`);
      if (spec.clusterIP === 'None') assert.equal(port, own.containerPort, 'nobody translates it');
    }
  for (const { spec } of of_kind('PodDisruptionBudget')) of_app(spec.selector.matchLabels.app);
  for (const { spec } of of_kind('NetworkPolicy')) {
    const own = spec.podSelector.matchLabels && of_app(spec.podSelector.matchLabels.app);
    for (const { from = [], ports } of spec.ingress ?? []) {
      for (const { port } of ports) assert.ok(port_names(own).includes(port), port);
      for (const { podSelector } of from) if (podSelector) of_app(podSelector.matchLabels.app);
    }
  }
});

test('nobody outside reaches NATS or a server', () => {
  const policies = of_kind('NetworkPolicy');
  assert.ok(policies.some(({ spec }) => !spec.podSelector.matchLabels && !spec.ingress),
      'what is not named is refused');
  for (const { metadata, spec } of policies)
    for (const { from } of spec.ingress ?? [])
      if (metadata.name !== 'proxy') assert.ok(from?.length > 0, metadata.name);
  const open = of_kind('Service').filter(({ spec }) => (spec.type ?? 'ClusterIP') !== 'ClusterIP');
  assert.deepEqual(open.map(({ metadata }) => metadata.name), ['proxy']);
});

test('no pod may more than it needs', () => {
  const dockerfile = read('docker/Dockerfile');
  for (const one of workloads) {
    const { securityContext, containers, automountServiceAccountToken } = pod_of(one);
    assert.equal(securityContext.runAsNonRoot, true);
    assert.ok(securityContext.runAsUser > 0);
    assert.equal(automountServiceAccountToken, false);
    for (const { image, resources, securityContext: own } of containers) {
      assert.deepEqual([own.allowPrivilegeEscalation, own.readOnlyRootFilesystem,
        own.capabilities.drop], [false, true, ['ALL']]);
      assert.ok(resources.limits.memory && resources.requests.cpu, image);
      if (!image.startsWith('wellspring-')) continue;
      assert.match(dockerfile, new RegExp(`^FROM \\S+ AS ${image.slice(11)}$`, 'm'));
      assert.ok(dockerfile.includes(`--uid ${securityContext.runAsUser} `), image);
      assert.ok(kustomization.images.some(({ name }) => name === image), image);
    }
  }
});

test('files and secrets that pods mount are made', () => {
  const made = new Map(kustomization.configMapGenerator.map((one) => [one.name, one.files]));
  for (const files of made.values())
    for (const file of files) assert.ok(existsSync(join(deploy, file)), file);
  const { status, stderr } = spawnSync('sh', [join(deploy, 'secrets.sh'), folder],
      { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
  const keys = [...readFileSync(join(folder, 'secrets.env'), 'utf8')
      .matchAll(/^(\w+)=[a-z]\w{47,}$/gm)].map(([, key]) => key);
  assert.equal(keys.length, 3);
  assert.equal(readFileSync(join(folder, 'seal.key')).length, 32);
  const told = new Map([...read('deploy/kubernetes/namespace.yaml')
      .matchAll(/create secret generic (\w+) --from-(?:env-)?file=FOLDER\/([\w.]+)$/gm)]
      .map(([, name, file]) => [name, file]));
  const secret = (name, key) => {
    assert.ok(told.has(name), `nobody makes the secret ${name}`);
    if (key) assert.ok(told.get(name) === key || keys.includes(key), `${name} has no ${key}`);
  };
  for (const one of workloads) {
    const { containers, volumes = [] } = pod_of(one);
    const claims = one.spec.volumeClaimTemplates ?? [];
    const known = new Map([...volumes.map((volume) => [volume.name, volume]),
      ...claims.map(({ metadata }) => [metadata.name, {}])]);
    for (const { env = [], envFrom = [], volumeMounts = [], args } of containers) {
      for (const { name, key } of env.map((one) => one.valueFrom?.secretKeyRef).filter(Boolean))
        secret(name, key);
      for (const { secretRef } of envFrom) secret(secretRef.name);
      for (const { name, subPath, mountPath } of volumeMounts) {
        const volume = known.get(name) ?? assert.fail(`${app_of(one)} has no volume ${name}`);
        if (volume.secret) secret(volume.secret.secretName, subPath);
        if (!volume.configMap) continue;
        const files = made.get(volume.configMap.name) ?? assert.fail(volume.configMap.name);
        const file = subPath ?? basename(args.at(-1));
        assert.ok(files.includes(file), `${name} has no ${file}`);
        assert.ok(mountPath === `/etc/wellspring/${file}`
            || args.at(-1) === join(mountPath, file), mountPath);
      }
    }
  }
});

const config_of = async (program, file) => {
  const { status, stdout, stderr } = await run(program, ['--config', join(deploy, file),
    '--print-config']);
  assert.equal(status, 0, stderr);
  return new Map([...stdout.matchAll(/^([a-z-]+) = (.*)$/gm)]
      .map(([, key, value]) => [key, value]));
};

test('the programs know what they are told, and it is what the manifests say', async () => {
  for (const name of ['server', 'worker']) {
    const program = `wellspring_${name}`;
    const { stdout } = await run(program, ['--help']);
    const [{ args, env = [] }] = pod_of(named('Deployment', name)).containers;
    for (const word of args.filter((one) => one.startsWith('-')))
      assert.match(stdout, new RegExp(`^ +${word} `, 'm'), `${program} ${word}`);
    for (const variable of env.filter((one) => one.name.startsWith('WELLSPRING_')))
      assert.ok(stdout.includes(variable.name), variable.name);
  }
  const server = await config_of('wellspring_server', 'server.conf');
  const worker = await config_of('wellspring_worker', 'worker.conf');
  const { spec } = named('Service', 'servers');
  assert.deepEqual(spec.ports.map(({ port }) => String(port)),
      [server.get('port'), server.get('agent-port')]);
  const nats = named('Service', 'nats');
  for (const address of [server.get('workers'), worker.get('nats')])
    assert.equal(address, `nats://${nats.metadata.name}:${nats.spec.ports[0].port}`);
  assert.equal(server.get('content'), worker.get('content'));
  const deployment = named('Deployment', 'server');
  const mounts = pod_of(deployment).containers[0].volumeMounts.map(({ mountPath }) => mountPath);
  for (const key of ['seal-key', 'cache']) assert.ok(mounts.includes(server.get(key)), key);
  assert.ok(pod_of(deployment).terminationGracePeriodSeconds > Number(server.get('drain')) + 10);
  const { maxUnavailable, maxSurge } = deployment.spec.strategy.rollingUpdate;
  assert.ok(maxUnavailable === 0 && maxSurge > 0, 'the new one serves before an old one ends');
  assert.equal(spec.publishNotReadyAddresses, true, 'HAProxy would cut the visits of who drains');
});

// What a container's environment is, as far as the manifest alone says it.
const environment = (container) => Object.fromEntries(container.env.map(({ name, value }) =>
  [name, value?.replace('$(NAMESPACE)', kustomization.namespace) ?? 'n0123456789abcdef']));

test('HAProxy and NATS take their files with the environment of their pods', async (context) => {
  const [proxy] = pod_of(of_app('proxy')).containers, [nats] = pod_of(of_app('nats')).containers;
  const env = environment(proxy), server = await config_of('wellspring_server', 'server.conf');
  assert.equal(env.NODES,
      `servers.${kustomization.namespace}.svc.cluster.local:${server.get('port')}`);
  assert.equal(env.AGENT, server.get('agent-port'));
  assert.equal(env.MUSEUM, `:${proxy.ports[0].containerPort}`);
  assert.equal(environment(nats).NATS_LISTEN, `0.0.0.0:${nats.ports[0].containerPort}`);
  const path = `${process.env.PATH}:/usr/sbin`;
  for (const [program, args, own] of [
    ['haproxy', ['-c', '-f', join(deploy, 'haproxy-nodes.cfg')], env],
    ['nats-server', ['-t', '-c', join(deploy, 'nats.conf')], environment(nats)]]) {
    const { error, status, stderr, stdout } = spawnSync(program, args,
        { encoding: 'utf8', env: { PATH: path, ...own } });
    if (error) context.diagnostic(`there is no ${program} here`);
    else assert.equal(status, 0, stdout + stderr);
  }
});

test('workers are scaled by what servers tell', () => {
  const { spec } = named('HorizontalPodAutoscaler', 'worker');
  const { kind, name } = spec.scaleTargetRef;
  assert.equal(named(kind, name).spec.replicas, undefined, 'one alone says how many there are');
  const { rules } = documents('kubernetes/metrics/adapter.yaml')[0];
  const rule = rules.external.find((one) => one.name.as === spec.metrics[0].external.metric.name);
  assert.ok(rule, 'the adapter knows the metric');
  const told = read('server/show/http/metrics.cpp');
  const series = `${rule.seriesQuery} ${rule.metricsQuery}`.match(/wellspring_\w+/g);
  for (const one of series.filter((word) => word !== rule.name.as))
    assert.ok(told.includes(`"${one.replace('wellspring_', '')}"`), `no server tells ${one}`);
  const [{ dns_sd_configs: [found] }] = documents('kubernetes/metrics/prometheus.yaml')[0]
      .scrape_configs;
  const servers = named('Service', 'servers');
  assert.deepEqual(found.names, [`servers.${kustomization.namespace}.svc.cluster.local`]);
  assert.equal(found.port, servers.spec.ports[0].port);
});

test('kubectl makes one whole of it', (context) => {
  const { error, status, stdout, stderr } = spawnSync('kubectl', ['kustomize', deploy],
      { encoding: 'utf8' });
  if (error) return context.skip('there is no kubectl here');
  assert.equal(status, 0, stderr);
  const whole = yaml.parseAllDocuments(stdout).map((one) => one.toJS());
  const kinds = (list) => list.map(({ kind }) => kind).filter((kind) => kind !== 'ConfigMap')
      .sort();
  assert.deepEqual(kinds(whole), kinds(all));
  assert.deepEqual(problems(whole), []);
  assert.ok(!/image: wellspring-/.test(stdout), 'images come from a registry');
});
