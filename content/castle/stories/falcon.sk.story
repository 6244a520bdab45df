<story>
<p><emotion name="joy" weight="0.35"/>Poďte <gesture name="beckon"/>sem a pozdravte najtichšieho hosťa tohto domu.
Pútnik si ho priniesol až z Alexandrie, <gesture name="small" weight="0.8"/>zašitého v plášti, a prisahal, že je to sokol z našej studne.
<gesture name="shrug" weight="0.6"/>Päťsto rokov nikto nevedel, čo je vnútri, <break time="250ms"/>lebo nikto sa neodvážil plátno rozrezať.</p>

<p><emotion name="joy" weight="0.3"/>Nôž nepotrebujete: <gesture name="explain" weight="0.7"/>podržte pred ním sklo a pozerajte sa.
Najprv zmizne plátno, <prosody rate="90%">vrstva za vrstvou, jedna za druhou.</prosody>
<emotion name="surprise" weight="0.5"/>A potom, <break time="400ms"/>je tam <gesture name="wonder"/><emphasis>vták</emphasis>!
Krídla má zložené a pazúry zovreté, <prosody volume="soft" rate="88%">akoby len <gesture name="hush" weight="0.6"/>zaspal.</prosody>
<emotion name="joy" weight="0.4"/>Dokonca v ňom ostalo aj jeho posledné jedlo, <gesture name="small"/>myš.</p>

<p><emotion name="surprise" weight="0.4"/>A teraz sa pozrite na jeho <gesture name="point_near"/>ľavú nohu.
To je <emphasis>zlatý</emphasis> prsteň a sokolovi je priveľký.
<emotion name="sadness" weight="0.4"/>Niekto si ho stiahol z vlastného <gesture name="heart"/>prsta, <break time="250ms"/><prosody rate="86%">skôr než ovinuli posledný obväz.</prosody></p>

<p><emotion name="fear" weight="0.35"/>A tá prasklina na maľovanej hlave, <gesture name="sigh"/>nuž, to som bol ja.
Hneď v deň, keď ho priniesli, mi <emphasis>spadol</emphasis>.
Prasklinu som uzavrel živicou a <gesture name="small" weight="0.8"/>kolíčkom zo zvonoviny, premaľoval som ju a nepovedal som to <gesture name="shake_head" weight="0.5"/>nikomu.
<break time="300ms"/><emotion name="joy" weight="0.6"/>Navždy by to bolo ostalo mojím tajomstvom, <break time="200ms"/>keby vám neboli dali to <gesture name="laugh" weight="0.7"/>sklo.</p>
</story>
